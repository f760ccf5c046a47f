#include "model/accel/quantize.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "model/accel/node_box.h"
#include "model/base/error.h"
#include "model/base/parallel.h"

namespace ctu::accel {
namespace {

constexpr std::size_t kChunkNodes = 4096;
constexpr float kLargest = std::numeric_limits<float>::max();

std::uint32_t largest_steps(std::uint32_t bits) { return (1u << bits) - 1; }

/// Steps from the origin to the plane; off by a part in 2^53, so what it is rounded to must be tried.
double steps_to(float plane, float origin, std::uint32_t exponent) {
  return (static_cast<double>(plane) - static_cast<double>(origin)) / static_cast<double>(step_of(exponent));
}

/// The smallest exponent whose `most` steps reach `upper`, as decoded.
std::uint32_t smallest_exponent(float lower, float upper, std::uint32_t most) {
  const double extent = static_cast<double>(upper) - static_cast<double>(lower);
  if (extent == 0) return 0;
  const int reached = std::ilogb(extent / most) + 149;  // a step of that is at most large enough
  auto exponent = static_cast<std::uint32_t>(std::max(reached, 0));
  while (most * static_cast<double>(step_of(exponent)) < extent) ++exponent;
  while (decode_upper(lower, exponent, most) < upper) ++exponent;
  return exponent;
}

/// The highest decoded plane at or below `plane`, among those whose offset is finite.
std::uint32_t steps_below(float plane, float origin, std::uint32_t exponent, std::uint32_t most) {
  const double finite = std::floor(static_cast<double>(kLargest) / static_cast<double>(step_of(exponent)));
  const double limit = std::min(static_cast<double>(most), finite);
  auto q = static_cast<std::uint32_t>(std::clamp(std::floor(steps_to(plane, origin, exponent)), 0.0, limit));
  while (q > 0 && decode_lower(origin, exponent, q) > plane) --q;
  // Rounded down, the next one may be the plane itself.
  if (q < limit && decode_lower(origin, exponent, q + 1) <= plane) ++q;
  return q;
}

/// The lowest decoded plane at or above `plane`.
std::uint32_t steps_above(float plane, float origin, std::uint32_t exponent, std::uint32_t most) {
  auto q = static_cast<std::uint32_t>(std::clamp(std::ceil(steps_to(plane, origin, exponent)), 0.0, double(most)));
  while (q < most && decode_upper(origin, exponent, q) < plane) ++q;
  if (q > 0 && decode_upper(origin, exponent, q - 1) >= plane) --q;
  return q;
}

}  // namespace

BoxFrame box_frame(const Node4& node, std::uint32_t bits) {
  const Box3 all = box_of_lanes(node);
  const Vec3 lower = to_vec3(all.lower), upper = to_vec3(all.upper);
  BoxFrame frame;
  for (int axis = 0; axis < 3; ++axis) {
    frame.origin[axis] = lower[axis];
    frame.set_exponent(axis, smallest_exponent(lower[axis], upper[axis], largest_steps(bits)));
  }
  return frame;
}

QuantizedBoxes quantize(const Node4& node, std::uint32_t bits) {
  const std::uint32_t most = largest_steps(bits);
  QuantizedBoxes boxes;
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = node.frame.origin[axis];
    const std::uint32_t exponent = node.frame.exponent(axis);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      if (node.child[lane] == kEmptyChild) continue;
      boxes.lo[axis][lane] = static_cast<std::uint16_t>(steps_below(node.boxes.lo[axis][lane], origin, exponent, most));
      boxes.hi[axis][lane] = static_cast<std::uint16_t>(steps_above(node.boxes.hi[axis][lane], origin, exponent, most));
    }
  }
  return boxes;
}

intersect::Box4 decode_boxes(const QuantizedBoxes& boxes, const BoxFrame& frame, const ChildRef* child) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  intersect::Box4 decoded;
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = frame.origin[axis];
    const std::uint32_t exponent = frame.exponent(axis);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const bool empty = child[lane] == kEmptyChild;
      decoded.lo[axis][lane] = empty ? kInfinity : decode_lower(origin, exponent, boxes.lo[axis][lane]);
      decoded.hi[axis][lane] = empty ? -kInfinity : decode_upper(origin, exponent, boxes.hi[axis][lane]);
    }
  }
  return decoded;
}

void quantize_boxes(Bvh4& bvh, std::uint32_t bits, int threads) {
  if (!is_reduced(bits))
    throw Error("box bits", fmt::format("{} bits for each coordinate", bits), "choose 16, 12 or 8, or 32 for binary32");
  parallel_chunks(bvh.nodes.size(), kChunkNodes, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      Node4& node = bvh.nodes[n];
      node.frame = box_frame(node, bits);
      node.boxes = decode_boxes(quantize(node, bits), node.frame, node.child);
    }
  });
}

}  // namespace ctu::accel
