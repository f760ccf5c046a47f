#include "model/accel/compact_node.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "model/accel/image_bytes.h"
#include "model/base/error.h"

namespace ctu::accel {
namespace {

constexpr int kExponentsOffset = 12;
constexpr int kChildOffset = 16;
constexpr int kPlanesOffset = 32;

/// Calls `visit(plane, place)` for the planes in the order of their places.
template <class Boxes, class Visit>
void for_each_plane(Boxes& boxes, Visit&& visit) {
  std::uint32_t place = 0;
  for (auto* planes : {&boxes.lo, &boxes.hi})
    for (auto& axis : *planes)
      for (auto& plane : axis) visit(plane, place++);
}

/// `bits` is a multiple of 4, so a number has whole halves of bytes.
void store_bits(std::uint8_t* p, std::uint32_t first, std::uint32_t bits, std::uint32_t value) {
  for (std::uint32_t i = 0; i < bits; i += 4) {
    const std::uint32_t at = first + i, shift = at % 8;
    p[at / 8] = static_cast<std::uint8_t>((p[at / 8] & ~(15u << shift)) | (value >> i & 15u) << shift);
  }
}
std::uint32_t load_bits(const std::uint8_t* p, std::uint32_t first, std::uint32_t bits) {
  std::uint32_t value = 0;
  for (std::uint32_t i = 0; i < bits; i += 4) value |= (p[(first + i) / 8] >> ((first + i) % 8) & 15u) << i;
  return value;
}

QuantizedBoxes read_planes(const std::uint8_t* p, std::uint32_t bits) {
  QuantizedBoxes boxes;
  for_each_plane(boxes, [&](std::uint16_t& plane, std::uint32_t place) {
    plane = static_cast<std::uint16_t>(load_bits(p + kPlanesOffset, place * bits, bits));
  });
  return boxes;
}

}  // namespace

void write_compact_node(const Node4& node, std::uint32_t bits, std::uint8_t* p) {
  QuantizedBoxes boxes = quantize(node, bits);
  const intersect::Box4 decoded = decode_boxes(boxes, node.frame, node.child);
  if (std::memcmp(&decoded, &node.boxes, sizeof decoded) != 0)
    throw Error("image", fmt::format("a box that {} bits for each coordinate cannot say", bits),
                "quantize the tree before its masks and its image are made");
  for (int axis = 0; axis < 3; ++axis) store_float(p + 4 * axis, node.frame.origin[axis]);
  store_u32(p + kExponentsOffset, node.frame.exponents);
  for (int lane = 0; lane < intersect::kLanes; ++lane) store_u32(p + kChildOffset + 4 * lane, node.child[lane]);
  for_each_plane(boxes, [&](const std::uint16_t& plane, std::uint32_t place) {
    store_bits(p + kPlanesOffset, place * bits, bits, plane);
  });
}

Node4 read_compact_node(const std::uint8_t* p, std::uint32_t bits) {
  Node4 node;
  for (int axis = 0; axis < 3; ++axis) node.frame.origin[axis] = load_float(p + 4 * axis);
  node.frame.exponents = load_u32(p + kExponentsOffset);
  for (int lane = 0; lane < intersect::kLanes; ++lane) node.child[lane] = load_u32(p + kChildOffset + 4 * lane);
  node.boxes = decode_boxes(read_planes(p, bits), node.frame, node.child);
  return node;
}

std::string compact_node_problem(const std::uint8_t* p, std::uint32_t bits) {
  const Node4 node = read_compact_node(p, bits);
  if (node.frame.exponents >> 30 != 0) return "bits beside the exponents";
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(node.frame.origin[axis])) return "an origin that is not finite";
    if (node.frame.exponent(axis) > kMaxStepExponent) return fmt::format("exponent {}", node.frame.exponent(axis));
  }
  QuantizedBoxes boxes = read_planes(p, bits);
  bool stray = false;
  for_each_plane(boxes, [&](const std::uint16_t& plane, std::uint32_t place) {
    stray |= plane != 0 && node.child[place % intersect::kLanes] == kEmptyChild;
  });
  return stray ? "an empty lane with a box" : "";
}

}  // namespace ctu::accel
