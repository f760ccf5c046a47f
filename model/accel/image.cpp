#include "model/accel/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "model/accel/forest.h"
#include "model/accel/image_bytes.h"
#include "model/base/error.h"

namespace ctu::accel {
namespace {

constexpr std::uint32_t kChildOffset = 96;
constexpr std::uint32_t kPrimitiveOffset = 36;
constexpr std::uint32_t kPrimitiveBoxOffset = 40;
constexpr std::uint32_t kMaxAlignmentBytes = 4096;
constexpr std::uint32_t kMaxMaskBits = 1u << 15;  // R = 32

void store_vec3(std::uint8_t* p, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) store_float(p + 4 * axis, v[axis]);
}
Vec3 load_vec3(const std::uint8_t* p) { return {load_float(p), load_float(p + 4), load_float(p + 8)}; }

std::uint64_t round_up(std::uint64_t x, std::uint64_t alignment) { return (x + alignment - 1) / alignment * alignment; }

[[noreturn]] void fail(std::string where, std::string what) {
  throw Error(std::move(where), std::move(what), "make the image again from the scene");
}

struct LanePlace {
  std::uint32_t node;
  int lane;
};
[[noreturn]] void fail(const LanePlace& where, std::string what) {
  fail(fmt::format("image, node {}, lane {}", where.node, where.lane), std::move(what));
}

bool is_alignment(std::uint32_t bytes) {
  return std::has_single_bit(bytes) && bytes >= 4 && bytes <= kMaxAlignmentBytes;
}

/// Everything but the contents: strides, addresses and the size that follow from layout and counts.
Image frame(const ImageLayout& layout, std::uint32_t nodes, std::uint32_t triangles) {
  Image image;
  image.layout = layout;
  image.node_stride_bytes = static_cast<std::uint32_t>(
      round_up(node_body_bytes(layout) + 4 * mask_bytes(layout), layout.node_alignment_bytes));
  image.triangle_stride_bytes =
      static_cast<std::uint32_t>(round_up(primitive_bytes(layout), layout.triangle_alignment_bytes));
  if (layout.bare_nodes != 0)
    image.bare_node_stride_bytes =
        static_cast<std::uint32_t>(round_up(node_body_bytes(layout), layout.node_alignment_bytes));
  image.node_count = nodes;
  image.triangle_count = triangles;
  image.triangle_base =
      round_up(image.node_address(nodes), std::max(kImageSectionAlignmentBytes, layout.triangle_alignment_bytes));
  return image;
}

void write_node(const Node4& node, std::uint32_t box_bits, std::uint8_t* p) {
  if (box_bits != kFullBoxBits) return write_compact_node(node, box_bits, p);
  for (int axis = 0; axis < 3; ++axis) {
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      store_float(p + 16 * axis + 4 * lane, node.boxes.lo[axis][lane]);
      store_float(p + 48 + 16 * axis + 4 * lane, node.boxes.hi[axis][lane]);
    }
  }
  for (int lane = 0; lane < intersect::kLanes; ++lane) store_u32(p + kChildOffset + 4 * lane, node.child[lane]);
}

void write_mask(const std::uint64_t* words, std::uint32_t bits, std::uint8_t* p) {
  for (std::uint32_t i = 0; i < (bits + 7) / 8; ++i) p[i] = static_cast<std::uint8_t>(words[i / 8] >> (8 * (i % 8)));
  if (bits % 8 != 0) p[bits / 8] &= static_cast<std::uint8_t>((1u << (bits % 8)) - 1);
}

void write_triangle(const LeafTriangle& triangle, std::uint8_t* p) {
  store_vec3(p, triangle.v0);
  store_vec3(p + 12, triangle.v1);
  store_vec3(p + 24, triangle.v2);
  store_u32(p + kPrimitiveOffset, triangle.primitive);
}

void write_primitive_box(const PrimitiveBox& box, std::uint8_t* p) {
  store_vec3(p + kPrimitiveBoxOffset, box.lower);
  store_vec3(p + kPrimitiveBoxOffset + 12, box.upper);
}

const std::uint8_t* node_bytes(const Image& image, std::uint32_t node) {
  if (node >= image.node_count) fail(fmt::format("image, node {}", node), fmt::format("of {}", image.node_count));
  return image.bytes.data() + image.node_address(node);
}

const std::uint8_t* primitive_at(const Image& image, std::uint32_t index) {
  if (index >= image.triangle_count)
    fail(fmt::format("image, triangle {}", index), fmt::format("of {}", image.triangle_count));
  return image.bytes.data() + image.triangle_address(index);
}

/// Collects what validate() needs to know of all trees while it walks from their roots.
class Validator {
 public:
  explicit Validator(const Image& image)
      : image_(image), node_depth_(image.node_count, 0), in_leaf_(image.triangle_count, false) {}

  void run() {
    check_frame();
    for (std::vector<std::uint32_t> open = roots(); !open.empty();) {
      const std::uint32_t n = open.back();
      open.pop_back();
      check_node(n, open);
    }
    const auto stray = std::find(node_depth_.begin(), node_depth_.end(), 0);
    if (stray != node_depth_.end())
      fail(fmt::format("image, node {}", stray - node_depth_.begin()), "no node on the way from a root refers to it");
    if (*std::max_element(node_depth_.begin(), node_depth_.end()) != image_.depth)
      fail("image, depth", "not the length of the longest path");
    const auto missing = std::find(in_leaf_.begin(), in_leaf_.end(), false);
    if (missing != in_leaf_.end()) fail(fmt::format("image, triangle {}", missing - in_leaf_.begin()), "in no leaf");
    std::uint32_t spheres = 0;
    for (std::uint32_t t = 0; t < image_.triangle_count; ++t) spheres += check_primitive(t);
    if (spheres != image_.sphere_count)
      fail("image, sphere_count", fmt::format("{} where there are {}", image_.sphere_count, spheres));
  }

  static void check_sizes(const Image& image) {
    validate(image.layout);
    if (image.node_count == 0 || image.node_count > 0x7FFFFFFFu) fail("image, node_count", "outside 1 .. 2^31-1");
    if (image.triangle_count == 0 || image.triangle_count > kMaxTriangles)
      fail("image, triangle_count", fmt::format("outside 1 .. {}", kMaxTriangles));
    const Image expected = frame(image.layout, image.node_count, image.triangle_count);
    if (image.layout.bare_nodes >= image.node_count) fail("image, bare_nodes", "the root is one of them");
    if (image.node_stride_bytes != expected.node_stride_bytes ||
        image.bare_node_stride_bytes != expected.bare_node_stride_bytes ||
        image.triangle_stride_bytes != expected.triangle_stride_bytes || image.node_base != expected.node_base ||
        image.triangle_base != expected.triangle_base)
      fail("image", "strides or addresses that do not follow from its layout");
    if (image.bytes.size() != expected.triangle_address(image.triangle_count))
      fail("image", fmt::format("{} bytes where its counts need {}", image.bytes.size(),
                                expected.triangle_address(image.triangle_count)));
  }

 private:
  std::vector<std::uint32_t> roots() {
    if (image_.trees() > kMostTrees) fail("image, further_roots", fmt::format("{} trees", image_.trees()));
    std::vector<std::uint32_t> roots;
    for (std::uint32_t tree = 0; tree < image_.trees(); ++tree) {
      const ChildRef root = image_.root(tree);
      if (root >= image_.masked_nodes()) fail("image, further_roots", fmt::format("{} is no node with masks", root));
      if (node_depth_[root] != 0) fail("image, further_roots", fmt::format("{} is the root of two trees", root));
      node_depth_[root] = 1;
      roots.push_back(root);
    }
    return roots;
  }

  void check_frame() const {
    if (!is_box(image_.lower, image_.upper)) fail("image, bounds", "not a box");
  }

  static bool is_box(const Vec3& lower, const Vec3& upper) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(lower[axis] <= upper[axis]) || !std::isfinite(lower[axis]) || !std::isfinite(upper[axis])) return false;
    }
    return true;
  }

  void check_frame_of(std::uint32_t n) const {
    if (image_.layout.box_bits == kFullBoxBits) return;
    const std::string problem = compact_node_problem(node_bytes(image_, n), image_.layout.box_bits);
    if (!problem.empty()) fail(fmt::format("image, node {}", n), problem);
  }

  void check_node(std::uint32_t n, std::vector<std::uint32_t>& open) {
    check_frame_of(n);
    const Node4 node = read_node(image_, n);
    bool empty_before = false;
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const LanePlace where{n, lane};
      check_box(node, lane, where);
      const ChildRef child = node.child[lane];
      if (child == kEmptyChild) {
        empty_before = true;
        continue;
      }
      if (empty_before) fail(where, "a child behind an empty lane");
      if (is_leaf(child)) {
        check_leaf(child, where);
      } else {
        check_inner(child, where);
        open.push_back(child);
      }
    }
    if (node.child[0] == kEmptyChild) fail(fmt::format("image, node {}", n), "no child");
  }

  static void check_box(const Node4& node, int lane, const LanePlace& where) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Vec3 lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = node.boxes.lo[axis][lane];
      upper[axis] = node.boxes.hi[axis][lane];
    }
    if (node.child[lane] != kEmptyChild) {
      if (!is_box(lower, upper)) fail(where, "not a box");
    } else if (lower != Vec3{kInfinity, kInfinity, kInfinity} || upper != Vec3{-kInfinity, -kInfinity, -kInfinity}) {
      fail(where, "an empty lane with a box");
    }
  }

  void check_inner(ChildRef child, const LanePlace& where) {
    const bool ordered = image_.layout.bare_nodes == 0;
    if (child >= image_.node_count || (ordered && child <= where.node))
      fail(where, fmt::format("child {} out of range", child));
    if (node_depth_[child] != 0) fail(where, fmt::format("child {} has two parents", child));
    node_depth_[child] = node_depth_[where.node] + 1;
  }

  void check_leaf(ChildRef child, const LanePlace& where) {
    const std::uint64_t first = leaf_first(child), last = first + static_cast<std::uint64_t>(leaf_count(child));
    if (last > image_.triangle_count || leaf_count(child) > kMaxLeafTriangles)
      fail(where, fmt::format("triangles {} to {} out of range", first, last - 1));
    for (std::uint64_t t = first; t < last; ++t) {
      if (in_leaf_[t]) fail(where, fmt::format("triangle {} is in two leaves", t));
      in_leaf_[t] = true;
    }
  }

  /// Whether it is a sphere.
  bool check_primitive(std::uint32_t t) const {
    const LeafTriangle primitive = read_triangle(image_, t);
    const auto refuse = [&](const char* what) { fail(fmt::format("image, triangle {}", t), what); };
    for (const Vec3& v : {primitive.v0, primitive.v1, primitive.v2}) {
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) refuse("a vertex that is not finite");
    }
    if (primitive.primitive == intersect::kNoPrimitive) refuse("no primitive id");
    const bool finite_box = is_box(box_of_primitive(primitive).lower, box_of_primitive(primitive).upper);
    if (primitive.is_sphere() && (!(primitive.v1.x >= 0) || !finite_box)) refuse("a sphere without a size");
    if (image_.layout.primitive_boxes && read_primitive_box(image_, t) != box_of_primitive(primitive))
      refuse("a box that is not the primitive's");
    return primitive.is_sphere();
  }

  const Image& image_;
  std::vector<int> node_depth_;  // 0: not referred to yet
  std::vector<bool> in_leaf_;
};

}  // namespace

void validate(const ImageLayout& layout) {
  const char* const where = "image layout";
  if (!is_alignment(layout.node_alignment_bytes) || !is_alignment(layout.triangle_alignment_bytes))
    throw Error(where,
                fmt::format("alignments are {} (nodes) and {} (triangles) bytes", layout.node_alignment_bytes,
                            layout.triangle_alignment_bytes),
                fmt::format("choose powers of two from 4 to {}", kMaxAlignmentBytes));
  if (layout.mask_bits > kMaxMaskBits)
    throw Error(where, fmt::format("mask_bits is {}", layout.mask_bits),
                fmt::format("choose at most {}", kMaxMaskBits));
  if (layout.box_bits != kFullBoxBits && !is_reduced(layout.box_bits))
    throw Error(where, fmt::format("box_bits is {}", layout.box_bits), "choose 32, 16, 12 or 8");
  if (layout.bare_nodes != 0 && layout.mask_bits == 0)
    throw Error(where, "bare nodes where no node carries masks", "choose 0 bare nodes");
}

Image make_image(const Bvh4& bvh, const std::uint64_t* masks, int words_per_mask, const ImageLayout& layout) {
  validate(layout);
  if (layout.mask_bits != 0 && (masks == nullptr || words_per_mask < static_cast<int>((layout.mask_bits + 63) / 64)))
    throw Error("image layout", fmt::format("{} mask bits but {} words", layout.mask_bits, words_per_mask),
                "give masks of ceil(mask_bits / 64) words, or no mask_bits");
  if (layout.bare_nodes != 0 && layout.bare_nodes >= bvh.nodes.size())
    throw Error("image layout", fmt::format("{} bare nodes of {}", layout.bare_nodes, bvh.nodes.size()),
                "leave the root its masks");
  Image image =
      frame(layout, static_cast<std::uint32_t>(bvh.nodes.size()), static_cast<std::uint32_t>(bvh.triangles.size()));
  image.sphere_count = bvh.spheres;
  image.depth = bvh.depth;
  image.further_roots = bvh.further_roots;
  image.lower = bvh.lower;
  image.upper = bvh.upper;
  image.bytes.resize(image.triangle_address(image.triangle_count));
  for (std::uint32_t n = 0; n < image.node_count; ++n) {
    std::uint8_t* const node = image.bytes.data() + image.node_address(n);
    write_node(bvh.nodes[n], layout.box_bits, node);
    for (std::size_t lane = 0; lane < intersect::kLanes && layout.mask_bits != 0 && n < image.masked_nodes(); ++lane)
      write_mask(masks + (4 * std::size_t{n} + lane) * static_cast<std::size_t>(words_per_mask), layout.mask_bits,
                 node + node_body_bytes(layout) + lane * mask_bytes(layout));
  }
  for (std::uint32_t t = 0; t < image.triangle_count; ++t) {
    std::uint8_t* const at = image.bytes.data() + image.triangle_address(t);
    write_triangle(bvh.triangles[t], at);
    if (layout.primitive_boxes) write_primitive_box(box_of_primitive(bvh.triangles[t]), at);
  }
  return image;
}

Node4 read_node(const Image& image, std::uint32_t index) {
  const std::uint8_t* const p = node_bytes(image, index);
  if (image.layout.box_bits != kFullBoxBits) return read_compact_node(p, image.layout.box_bits);
  Node4 node;
  for (int axis = 0; axis < 3; ++axis) {
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      node.boxes.lo[axis][lane] = load_float(p + 16 * axis + 4 * lane);
      node.boxes.hi[axis][lane] = load_float(p + 48 + 16 * axis + 4 * lane);
    }
  }
  for (int lane = 0; lane < intersect::kLanes; ++lane) node.child[lane] = load_u32(p + kChildOffset + 4 * lane);
  return node;
}

LeafTriangle read_triangle(const Image& image, std::uint32_t index) {
  const std::uint8_t* const p = primitive_at(image, index);
  return {load_vec3(p), load_vec3(p + 12), load_vec3(p + 24), load_u32(p + kPrimitiveOffset)};
}

PrimitiveBox read_primitive_box(const Image& image, std::uint32_t index) {
  if (!image.layout.primitive_boxes) fail("image", "primitives without boxes");
  const std::uint8_t* const p = primitive_at(image, index) + kPrimitiveBoxOffset;
  return {load_vec3(p), load_vec3(p + 12)};
}

void read_mask(const Image& image, std::uint32_t node, int lane, std::uint64_t* words) {
  if (node >= image.masked_nodes()) fail(fmt::format("image, node {}", node), "carries no masks");
  const std::uint32_t bytes = mask_bytes(image.layout);
  const std::uint8_t* const p =
      node_bytes(image, node) + node_body_bytes(image.layout) + static_cast<std::uint32_t>(lane) * bytes;
  std::fill_n(words, (bytes + 7) / 8, std::uint64_t{0});
  for (std::uint32_t i = 0; i < bytes; ++i) words[i / 8] |= static_cast<std::uint64_t>(p[i]) << (8 * (i % 8));
}

Bvh4 decode(const Image& image) {
  Bvh4 bvh;
  bvh.nodes.reserve(image.node_count);
  for (std::uint32_t n = 0; n < image.node_count; ++n) bvh.nodes.push_back(read_node(image, n));
  bvh.triangles.reserve(image.triangle_count);
  for (std::uint32_t t = 0; t < image.triangle_count; ++t) bvh.triangles.push_back(read_triangle(image, t));
  bvh.spheres = image.sphere_count;
  bvh.further_roots = image.further_roots;
  bvh.lower = image.lower;
  bvh.upper = image.upper;
  bvh.depth = image.depth;
  return bvh;
}

void validate(const Image& image) {
  Validator::check_sizes(image);
  Validator(image).run();
}

}  // namespace ctu::accel
