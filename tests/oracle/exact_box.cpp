#include "tests/oracle/exact_box.h"

#include "tests/oracle/rational.h"

namespace ctu::oracle {

using numeric::Round;

namespace {

Rational plane_time(const intersect::Ray& ray, int axis, float plane) {
  return (exact(plane) - exact(ray.origin[axis])) / exact(ray.direction[axis]);
}

ExactTime enclose(const Rational& t) {
  if (t == 0) return {0.0f, 0.0f};
  return {round_rational(t, Round::Down), round_rational(t, Round::Up)};
}

/// The ray's part in the closed box; false where it never enters one of the slabs it does not move along.
bool clip_to_box(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, Span& span) {
  for (int axis = 0; axis < 3; ++axis) {
    const float o = ray.origin[axis], d = ray.direction[axis];
    if (!(lo[axis] <= hi[axis])) return false;
    if (d == 0) {
      if (o < lo[axis] || o > hi[axis]) return false;
      continue;
    }
    span.start_at(plane_time(ray, axis, d > 0 ? lo[axis] : hi[axis]));
    span.stop_at(plane_time(ray, axis, d > 0 ? hi[axis] : lo[axis]));
  }
  return !span.empty();
}

}  // namespace

ExactTime exact_plane_time(const intersect::Ray& ray, int axis, float plane) {
  return enclose(plane_time(ray, axis, plane));
}

ExactBoxSpan exact_box_span(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, float tmin, float tmax) {
  Span span;
  clip(span, tmin, tmax);
  if (span.empty() || !clip_to_box(ray, lo, hi, span)) return {};
  return {true, enclose(span.from.at), enclose(span.to.at)};
}

bool exact_ray_hits_box(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, float tmin, float tmax) {
  return exact_box_span(ray, lo, hi, tmin, tmax).hit;
}

}  // namespace ctu::oracle
