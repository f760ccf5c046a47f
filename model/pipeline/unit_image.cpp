#include "model/pipeline/unit_image.h"

#include <algorithm>

#include "model/cull/mask_words.h"

namespace ctu::pipeline {

UnitImage::UnitImage(const accel::Image& image, const cull::MaskTester& tester, bool arithmetic, int packet_entries)
    : masked_nodes_(image.masked_nodes()),
      box_bits_(image.layout.box_bits),
      bare_base_(image.node_address(masked_nodes_)),
      bare_stride_(image.bare_node_stride_bytes),
      node_base_(image.node_base),
      node_stride_(image.node_stride_bytes),
      triangle_base_(image.triangle_base),
      triangle_stride_(image.triangle_stride_bytes),
      end_(image.bytes.size()),
      depth_(image.depth),
      packet_entries_(packet_entries),
      lut_(tester.compression_lut()),
      mask_words_(static_cast<std::size_t>(cull::words_per_mask(tester.options().resolution))),
      children_(image.node_count),
      spheres_(image.sphere_count),
      has_primitive_boxes_(image.layout.primitive_boxes),
      primitives_(image.triangle_count),
      full_lanes_(image.node_count) {
  for (std::uint32_t tree = 0; tree < image.trees(); ++tree) roots_.push_back(image.root(tree));
  if (arithmetic) {
    boxes_.resize(image.node_count);
    triangles_.resize(image.triangle_count);
  }
  for (std::uint32_t n = 0; n < image.node_count; ++n) {
    const accel::Node4 node = accel::read_node(image, n);
    for (unsigned lane = 0; lane < 4; ++lane) children_[n][lane] = node.child[lane];
    if (arithmetic) boxes_[n] = node.boxes;
  }
  for (std::uint32_t t = 0; t < image.triangle_count; ++t) {
    const accel::LeafTriangle triangle = accel::read_triangle(image, t);
    primitives_[t] = triangle.primitive;
    if (arithmetic) triangles_[t] = triangle;
    if (arithmetic && has_primitive_boxes_) primitive_boxes_.push_back(accel::read_primitive_box(image, t));
  }
  if (tester.design() == cull::Design::None) return;
  std::fill(full_lanes_.begin() + masked_nodes_, full_lanes_.end(), std::uint8_t{15});  // bare nodes
  if (lut_ != nullptr)
    read_indices(image);
  else
    read_masks(image, tester, arithmetic);
}

void UnitImage::read_masks(const accel::Image& image, const cull::MaskTester& tester, bool arithmetic) {
  const std::size_t node_words = 4 * mask_words_;
  std::vector<std::uint64_t> one_node(arithmetic ? 0 : node_words);
  if (arithmetic) masks_.resize(image.node_count * node_words);
  const std::vector<std::uint64_t> full = cull::full_mask(tester.options().resolution);
  for (std::size_t lane = 4 * std::size_t{masked_nodes_}; arithmetic && lane < 4 * std::size_t{image.node_count};
       ++lane)
    std::copy(full.begin(), full.end(), masks_.begin() + static_cast<std::ptrdiff_t>(lane * mask_words_));
  for (std::uint32_t n = 0; n < masked_nodes_; ++n) {
    std::uint64_t* const words = arithmetic ? masks_.data() + n * node_words : one_node.data();
    for (int lane = 0; lane < 4; ++lane)
      accel::read_mask(image, n, lane, words + static_cast<std::size_t>(lane) * mask_words_);
    full_lanes_[n] = static_cast<std::uint8_t>(cull::full_lanes(words, tester.options().resolution));
  }
}

void UnitImage::read_indices(const accel::Image& image) {
  const auto full = static_cast<std::uint64_t>(lut_->entries() - 1);
  mask_index_.resize(static_cast<std::size_t>(image.node_count) * 4, static_cast<std::uint16_t>(full));
  for (std::uint32_t n = 0; n < masked_nodes_; ++n)
    for (int lane = 0; lane < 4; ++lane) {
      std::uint64_t index = 0;
      accel::read_mask(image, n, lane, &index);
      mask_index_[static_cast<std::size_t>(n) * 4 + static_cast<unsigned>(lane)] = static_cast<std::uint16_t>(index);
      if (index == full) full_lanes_[n] = static_cast<std::uint8_t>(full_lanes_[n] | 1u << lane);
    }
}

}  // namespace ctu::pipeline
