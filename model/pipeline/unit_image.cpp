#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

UnitImage::UnitImage(const accel::Image& image, bool arithmetic)
    : node_base_(image.node_base),
      node_stride_(image.node_stride_bytes),
      triangle_base_(image.triangle_base),
      triangle_stride_(image.triangle_stride_bytes),
      end_(image.bytes.size()),
      depth_(image.depth),
      mask_bits_(image.layout.mask_bits),
      mask_words_((image.layout.mask_bits + 63) / 64),
      children_(image.node_count),
      primitives_(image.triangle_count) {
  if (arithmetic) {
    boxes_.resize(image.node_count);
    triangles_.resize(image.triangle_count);
    masks_.resize(static_cast<std::size_t>(image.node_count) * 4 * mask_words_);
  }
  for (std::uint32_t n = 0; n < image.node_count; ++n) {
    const accel::Node4 node = accel::read_node(image, n);
    for (unsigned lane = 0; lane < 4; ++lane) children_[n][lane] = node.child[lane];
    if (!arithmetic) continue;
    boxes_[n] = node.boxes;
    for (int lane = 0; lane < 4 && mask_words_ > 0; ++lane)
      accel::read_mask(image, n, lane,
                       masks_.data() + (static_cast<std::size_t>(n) * 4 + static_cast<unsigned>(lane)) * mask_words_);
  }
  for (std::uint32_t t = 0; t < image.triangle_count; ++t) {
    const accel::LeafTriangle triangle = accel::read_triangle(image, t);
    primitives_[t] = triangle.primitive;
    if (arithmetic) triangles_[t] = triangle;
  }
}

}  // namespace ctu::pipeline
