// Three intervals: where a point or a direction may be.
#pragma once

#include "model/numeric/interval.h"
#include "model/numeric/vec3.h"

namespace ctu::numeric {

struct IntervalVector {
  Interval x, y, z;

  static IntervalVector point(const Vec3& v) {
    return {Interval::point(v.x), Interval::point(v.y), Interval::point(v.z)};
  }
  static IntervalVector nothing() { return {Interval::nothing(), Interval::nothing(), Interval::nothing()}; }

  const Interval& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  Interval& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  bool operator==(const IntervalVector&) const = default;
};

inline IntervalVector unite(const IntervalVector& a, const IntervalVector& b) {
  return {unite(a.x, b.x), unite(a.y, b.y), unite(a.z, b.z)};
}
inline IntervalVector operator-(const IntervalVector& a) { return {-a.x, -a.y, -a.z}; }
inline IntervalVector operator+(const IntervalVector& a, const IntervalVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline IntervalVector operator-(const IntervalVector& a, const IntervalVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline IntervalVector operator*(const IntervalVector& a, const Interval& s) { return {a.x * s, a.y * s, a.z * s}; }
inline IntervalVector difference(const Vec3& a, const Vec3& b) {
  return {difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z)};
}
inline Interval dot(const IntervalVector& a, const IntervalVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline IntervalVector cross(const IntervalVector& a, const IntervalVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Tighter than dot(a, a).
inline Interval squared_length(const IntervalVector& a) { return square(a.x) + square(a.y) + square(a.z); }

}  // namespace ctu::numeric
