#include "tests/oracle/exact_triangle.h"

#include "tests/oracle/rational.h"

namespace ctu::oracle {

using numeric::Round;

namespace {

ExactTriangleHit hit_from(const Span& span) {
  if (span.empty()) return {};
  const Rational& t = span.from.at;
  ExactTriangleHit hit;
  hit.hit = true;
  hit.edge_on = true;
  hit.nearest_t = t.get_d();
  if (t != 0) hit.t = {round_rational(t, Round::Down), round_rational(t, Round::Up)};
  return hit;
}

/// The part of the ray on the segment p..q (a point if they are equal).
bool clip_to_segment(const Vec3q& o, const Vec3q& d, const Vec3q& p, const Vec3q& q, Span& span) {
  const Vec3q along = q - p, to_p = p - o, normal = cross(d, along);
  if (is_zero(normal)) {
    if (!is_zero(cross(to_p, d))) return false;
    const Rational length = dot(d, d), at_p = dot(to_p, d) / length, at_q = dot(q - o, d) / length;
    span.start_at(at_p < at_q ? at_p : at_q);
    span.stop_at(at_p < at_q ? at_q : at_p);
    return true;
  }
  if (dot(to_p, normal) != 0) return false;
  const Rational length = dot(normal, normal), s = dot(cross(to_p, d), normal) / length;
  if (s < 0 || s > 1) return false;
  const Rational t = dot(cross(to_p, along), normal) / length;
  span.start_at(t);
  span.stop_at(t);
  return true;
}

/// The longest of the three edges: all of a triangle without area.
bool clip_to_collapsed(const Vec3q& o, const Vec3q& d, const std::array<Vec3q, 3>& v, Span& span) {
  int longest = 0;
  Rational best = -1;
  for (int i = 0; i < 3; ++i) {
    const Vec3q edge = v[(i + 1) % 3] - v[i];
    if (dot(edge, edge) > best) best = dot(edge, edge), longest = i;
  }
  return clip_to_segment(o, d, v[longest], v[(longest + 1) % 3], span);
}

/// The ray lies in the plane of the triangle: three half-planes, seen along the normal.
bool clip_in_plane(const Vec3q& o, const Vec3q& d, const std::array<Vec3q, 3>& v, const Vec3q& normal, Span& span) {
  for (int i = 0; i < 3; ++i) {
    const Vec3q inward = cross(normal, v[(i + 1) % 3] - v[i]);
    const Rational rate = dot(inward, d), height = dot(inward, o - v[i]);
    if (rate == 0) {
      if (height < 0) return false;
      continue;
    }
    const Rational t = -height / rate;
    if (rate > 0)
      span.start_at(t);
    else
      span.stop_at(t);
  }
  return true;
}

}  // namespace

ExactTriangleHit exact_ray_triangle(const intersect::Ray& ray, const Vec3& v0, const Vec3& v1, const Vec3& v2,
                                    float tmin, float tmax) {
  const Vec3q o = exact(ray.origin), d = exact(ray.direction);
  const std::array<Vec3q, 3> v{exact(v0), exact(v1), exact(v2)};
  const Vec3q e1 = v[1] - v[0], e2 = v[2] - v[0], normal = cross(e1, e2), to_origin = o - v[0];
  Span span;
  clip(span, tmin, tmax);
  if (span.empty()) return {};
  if (is_zero(normal)) return clip_to_collapsed(o, d, v, span) ? hit_from(span) : ExactTriangleHit{};
  const Rational det = -dot(d, normal);
  if (det == 0) {
    if (dot(to_origin, normal) != 0) return {};
    return clip_in_plane(o, d, v, normal, span) ? hit_from(span) : ExactTriangleHit{};
  }
  const Vec3q side = cross(to_origin, d);
  const Rational t = dot(to_origin, normal) / det, b1 = dot(e2, side) / det, b2 = -dot(e1, side) / det;
  if (b1 < 0 || b2 < 0 || b1 + b2 > 1) return {};
  span.start_at(t);
  span.stop_at(t);
  ExactTriangleHit hit = hit_from(span);
  hit.edge_on = false;
  hit.u = b1.get_d();
  hit.v = b2.get_d();
  hit.on_edge = b1 == 0 || b2 == 0 || b1 + b2 == 1;
  return hit;
}

int exact_sign_of_difference(double a, double b, double c, double d) {
  return sgn(Rational(Rational(a) * Rational(b) - Rational(c) * Rational(d)));
}

}  // namespace ctu::oracle
