// Shared by the .cpp files that compute with rationals: to and from binary32, exact vectors, intervals of t.
#pragma once

#include <gmpxx.h>

#include <array>

#include "model/intersect/ray.h"
#include "model/numeric/round.h"

namespace ctu::oracle {

using Rational = mpq_class;
using Vec3q = std::array<Rational, 3>;

/// A rational that is not zero, rounded to binary32; overflow and underflow as IEEE 754 says.
float round_rational(const Rational& x, numeric::Round round);

/// To 24 significant bits, to nearest even, whatever the exponent: the numbers inside the triangle test.
Rational round24(const Rational& x);

/// The triangle test's results: binary32, to nearest even, every zero +0.
float quotient_binary32(const Rational& x);

inline Rational exact(float x) { return Rational(static_cast<double>(x)); }
inline Vec3q exact(const Vec3& v) { return {exact(v.x), exact(v.y), exact(v.z)}; }

inline Vec3q operator-(const Vec3q& a, const Vec3q& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Rational dot(const Vec3q& a, const Vec3q& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3q cross(const Vec3q& a, const Vec3q& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const Vec3q& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

/// One end of an interval of t: a number or an infinity, and whether the end itself belongs to it.
struct End {
  Rational at;
  bool infinite = false;
  bool open = false;
};

/// The points of a ray with t between two ends; `narrow` intersects.
struct Span {
  End from{0, true}, to{0, true};

  void start_at(const Rational& t, bool open = false) {
    if (from.infinite || t > from.at || (t == from.at && open)) from = {t, false, open};
  }
  void stop_at(const Rational& t, bool open = false) {
    if (to.infinite || t < to.at || (t == to.at && open)) to = {t, false, open};
  }
  bool empty() const {
    if (from.infinite || to.infinite) return false;
    return from.at > to.at || (from.at == to.at && (from.open || to.open));
  }
};

/// Start and stop at binary32 times, which may be infinities.
inline void clip(Span& span, float tmin, float tmax) {
  if (tmin > -std::numeric_limits<float>::infinity()) span.start_at(exact(tmin));
  if (tmax < std::numeric_limits<float>::infinity()) span.stop_at(exact(tmax));
}

}  // namespace ctu::oracle
