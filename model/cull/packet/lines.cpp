#include "model/cull/packet/lines.h"

#include <algorithm>
#include <cmath>

namespace ctu::cull::packet {
namespace {

using intersect::Ray;
using numeric::Round;

float largest_component(const Vec3& d) { return std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}); }

/// The least share that the axis has in any direction, or 0 unless all directions have its sign.
float share_of_axis(std::span<const Ray> rays, int axis) {
  const bool negative = rays.front().direction[axis] < 0;
  float least = 1;
  for (const Ray& ray : rays) {
    const float d = ray.direction[axis];
    if (d == 0 || (d < 0) != negative) return 0;
    least = std::min(least, std::fabs(d) / largest_component(ray.direction));
  }
  return least;
}

/// The paper takes the first axis that all directions agree on; the one that they keep to best has the least slopes.
int major_axis(std::span<const Ray> rays) {
  int best = -1;
  float most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float share = share_of_axis(rays, axis);
    if (share > most) best = axis, most = share;
  }
  return best;
}

/// The middle of the box around the origins.
Vec3 middle_of_origins(std::span<const Ray> rays) {
  Vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    float lo = rays.front().origin[axis], hi = lo;
    for (const Ray& ray : rays) {
      lo = std::min(lo, ray.origin[axis]);
      hi = std::max(hi, ray.origin[axis]);
    }
    middle[axis] = lo == hi ? lo : 0.5f * lo + 0.5f * hi;
  }
  return middle;
}

float power_of_two_of(const Vec3& d) {
  constexpr int kLargest = 126;  // its reciprocal is a normal number too
  return std::ldexp(1.0f, std::clamp(std::ilogb(largest_component(d)), -kLargest, kLargest));
}

Interval quotient(float a, float b) {
  if (b == 1) return Interval::point(a);
  return Interval::point(a) / Interval::point(b);
}

Interval product(float a, float b) {
  if (b == 1) return Interval::point(a);
  numeric::OperationMeter::add(0, 2);
  return {numeric::mul<Round::Down>(a, b), numeric::mul<Round::Up>(a, b)};
}

Line make_line(const Ray& ray, const Lines& lines, float scale) {
  Line line;
  line.scale = scale;
  line.origin = lines.shared_origin ? IntervalVector{} : lines.relative(ray.origin);
  for (int axis = 0; axis < 3; ++axis) line.direction[axis] = quotient(ray.direction[axis], scale);
  line.first = product(ray.tmin, scale);
  line.last = product(ray.tmax, scale);
  return line;
}

}  // namespace

void Lines::extend(Reach& reach, std::size_t i, float t) const {
  const Line& line = lines[i];
  const float time = product(t, line.scale).hi;
  reach.time = numeric::max(reach.time, time);
  if (axis >= 0) reach.forward = numeric::max(reach.forward, (forward(line.origin) + Interval::point(time)).hi);
}

Lines make_lines(std::span<const Ray> rays, Scale scale) {
  Lines lines;
  lines.reference = middle_of_origins(rays);
  lines.shared_origin =
      std::all_of(rays.begin(), rays.end(), [&](const Ray& r) { return r.origin == lines.reference; });
  lines.axis = major_axis(rays);
  lines.backward = lines.axis >= 0 && rays.front().direction[lines.axis] < 0;
  lines.lines.reserve(rays.size());
  for (const Ray& ray : rays) {
    const float length = lines.axis >= 0 ? std::fabs(ray.direction[lines.axis]) : power_of_two_of(ray.direction);
    lines.lines.push_back(make_line(ray, lines, scale == Scale::AsGiven ? 1.0f : length));
  }
  return lines;
}

}  // namespace ctu::cull::packet
