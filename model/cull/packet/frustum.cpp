#include "model/cull/packet/frustum.h"

#include <cmath>

namespace ctu::cull::packet {
namespace {

/// Where a line begins.
Interval begin_on_axis(const Line& line, int axis) { return line.origin[axis] + line.direction[axis] * line.first; }

FrustumSide side_on_axis(const Lines& lines, int axis, float back) {
  FrustumSide side;
  side.axis = axis;
  Interval slopes = Interval::nothing();
  for (const Line& line : lines.lines) slopes = unite(slopes, line.direction[axis]);
  side.low_slope = slopes.lo, side.high_slope = slopes.hi;
  // The plane's origin: the begin that lies furthest out, carried back along the plane (section 4.1.4).
  Interval low = Interval::nothing(), high = Interval::nothing();
  for (const Line& line : lines.lines) {
    const Interval begin = begin_on_axis(line, axis);
    const Interval advance = lines.forward(line.origin) + line.first - Interval::point(back);
    low = unite(low, begin - advance * Interval::point(slopes.lo));
    high = unite(high, begin - advance * Interval::point(slopes.hi));
  }
  side.low = low.lo, side.high = high.hi;
  return side;
}

bool finite(const FrustumSide& side) {
  return std::isfinite(side.low) && std::isfinite(side.high) && std::isfinite(side.low_slope) &&
         std::isfinite(side.high_slope);
}

}  // namespace

std::optional<Frustum> make_frustum(const Lines& lines) {
  if (lines.axis < 0) return std::nullopt;
  Interval begins = Interval::nothing(), ends = Interval::nothing();
  for (const Line& line : lines.lines) {
    const Interval origin = lines.forward(line.origin);
    begins = unite(begins, origin + line.first);
    ends = unite(ends, {(origin + Interval::point(line.last.lo)).lo, (origin + Interval::point(line.last.hi)).hi});
  }
  Frustum frustum;
  frustum.back = begins.lo, frustum.all_begun = begins.hi;
  frustum.first_end = ends.lo, frustum.front = ends.hi;
  if (!std::isfinite(frustum.back)) return std::nullopt;
  for (int i = 0; i < 2; ++i) {
    frustum.side[i] = side_on_axis(lines, (lines.axis + 1 + i) % 3, frustum.back);
    if (!finite(frustum.side[i])) return std::nullopt;
  }
  return frustum;
}

}  // namespace ctu::cull::packet
