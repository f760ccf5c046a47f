#include "tests/oracle/ray_oracle.h"

#include <algorithm>
#include <cmath>

#include "tests/oracle/exact_sphere.h"
#include "tests/oracle/exact_sum.h"
#include "tests/oracle/in_plane.h"

namespace ctu::oracle {

namespace {

constexpr double kBound = 16 * 0x1p-53;
constexpr int kDoubt = 2;

/// A sum of products as binary64 has it, and the same sum of magnitudes.
struct Estimate {
  double value, magnitude;

  /// -1, 0, +1, or kDoubt. Where every product has a factor 0 the sum is 0.
  int sign() const {
    if (std::fabs(value) > kBound * magnitude) return value > 0 ? 1 : -1;
    return magnitude == 0 ? 0 : kDoubt;
  }
};

template <class Vector>
Estimate triple(const Vector& a, const Vector& b, const Vector& c) {
  const double yz = b.y * c.z, zy = b.z * c.y, zx = b.z * c.x, xz = b.x * c.z, xy = b.x * c.y, yx = b.y * c.x;
  return {a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx), std::fabs(a.x) * (std::fabs(yz) + std::fabs(zy)) +
                                                                   std::fabs(a.y) * (std::fabs(zx) + std::fabs(xz)) +
                                                                   std::fabs(a.z) * (std::fabs(xy) + std::fabs(yx))};
}

/// Binary64 operations that notice whether any of them rounded: on simple numbers none does, and then even a sum of 0
/// is certain.
class Watched {
 public:
  bool exact() const { return exact_; }
  double plus(double a, double b) {
    const double sum = a + b, from_b = sum - a;
    exact_ &= (a - (sum - from_b)) + (b - from_b) == 0;
    return sum;
  }
  double minus(double a, double b) { return plus(a, -b); }
  double times(double a, double b) {
    const double product = a * b;
    exact_ &= std::fma(a, b, -product) == 0;
    return product;
  }
  template <class Vector>
  double triple(const Vector& a, const Vector& b, const Vector& c) {
    const double x = times(a.x, minus(times(b.y, c.z), times(b.z, c.y)));
    const double y = times(a.y, minus(times(b.z, c.x), times(b.x, c.z)));
    const double z = times(a.z, minus(times(b.x, c.y), times(b.y, c.x)));
    return plus(plus(x, y), z);
  }
  template <class Vector>
  Vector difference(const Vec3& p, const Vec3& q) {
    return {minus(p.x, q.x), minus(p.y, q.y), minus(p.z, q.z)};
  }

 private:
  bool exact_ = true;
};

int sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Adds scale a . (b x c); scale and each number have 24 bits.
void add_triple(ExactSum& sum, double scale, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    const double first = scale * a[axis];
    sum.add_product(first, static_cast<double>(b[next]) * c[last]);
    sum.add_product(-first, static_cast<double>(b[last]) * c[next]);
  }
}

/// The sign of d . ((p - o) x (q - o)).
template <class Vector>
int edge_sign(const intersect::Ray& ray, const Vector& direction, const Vec3& p, const Vec3& q) {
  Watched watched;
  const Vector to = watched.difference<Vector>(p, ray.origin), edge = watched.difference<Vector>(q, p);
  const double plain = watched.triple(direction, to, edge);
  if (watched.exact()) return sign_of(plain);
  ExactSum sum;
  add_triple(sum, 1, ray.direction, p, q);
  add_triple(sum, -1, ray.direction, ray.origin, q);
  add_triple(sum, -1, ray.direction, p, ray.origin);
  return sum.sign();
}

/// The sign of (v0 - o - t d) . n, n the triangle's normal v0 x v1 + v1 x v2 + v2 x v0.
template <class Vector>
int height_sign(const intersect::Ray& ray, const Vector& direction, const Vec3 (&v)[3], float t) {
  Watched watched;
  const Vector to = watched.difference<Vector>(v[0], ray.origin), e1 = watched.difference<Vector>(v[1], v[0]),
               e2 = watched.difference<Vector>(v[2], v[1]);
  const double plain = watched.minus(watched.triple(to, e1, e2), watched.times(t, watched.triple(direction, e1, e2)));
  if (watched.exact()) return sign_of(plain);
  ExactSum sum;
  add_triple(sum, 1, v[0], v[1], v[2]);
  for (int i = 0; i < 3; ++i) {
    add_triple(sum, -1, ray.origin, v[i], v[(i + 1) % 3]);
    if (t != 0) add_triple(sum, -static_cast<double>(t), ray.direction, v[i], v[(i + 1) % 3]);
  }
  return sum.sign();
}

/// The three edge functions: on a line that meets the triangle's inside they have one sign.
struct EdgeSigns {
  int of[3];
  bool disagree() const { return has(1) && has(-1); }
  bool has(int sign) const { return of[0] == sign || of[1] == sign || of[2] == sign; }
  /// The sign that those have which are not 0; 0 where all are.
  int common() const { return has(1) ? 1 : has(-1) ? -1 : 0; }
};

}  // namespace

RayOracle::RayOracle(const intersect::Ray& ray)
    : ray_(ray),
      origin_{ray.origin.x, ray.origin.y, ray.origin.z},
      direction_{ray.direction.x, ray.direction.y, ray.direction.z},
      tmin_(ray.tmin),
      tmax_(ray.tmax),
      bounded_(std::isfinite(ray.tmax)) {}

RayOracle::Vector RayOracle::from_origin(const Vec3& point) const {
  return {point.x - origin_.x, point.y - origin_.y, point.z - origin_.z};
}

bool RayOracle::meets_triangle(const Vec3& v0, const Vec3& v1, const Vec3& v2) {
  ++counts_.asked;
  const Vec3 v[3] = {v0, v1, v2};
  const Vector to[3] = {from_origin(v0), from_origin(v1), from_origin(v2)};
  Vector edge[3];
  EdgeSigns signs;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &p = v[i], &q = v[(i + 1) % 3];
    edge[i] = {static_cast<double>(q.x) - p.x, static_cast<double>(q.y) - p.y, static_cast<double>(q.z) - p.z};
    signs.of[i] = triple(direction_, to[i], edge[i]).sign();
  }
  if (signs.disagree()) return false;
  bool doubt = signs.has(kDoubt);
  if (doubt) {
    for (int i = 0; i < 3; ++i)
      if (signs.of[i] == kDoubt) signs.of[i] = edge_sign(ray_, direction_, v[i], v[(i + 1) % 3]);
  }
  const int orientation = signs.common();
  bool meets = false;
  if (orientation == 0) {
    doubt = true;
    meets = box_of_triangle_is_met(v) && meets_in_plane(ray_, v);
  } else if (!signs.disagree()) {
    // The point is at t = (v0 - o) . n / (d . n), and the sign of d . n is the edges'.
    const Estimate height = triple(to[0], edge[0], edge[1]), rate = triple(direction_, edge[0], edge[1]);
    const auto side_of = [&](double t) {
      const Estimate beyond{height.value - t * rate.value, height.magnitude + std::fabs(t) * rate.magnitude};
      const int sign = beyond.sign();
      if (sign != kDoubt) return sign * orientation;
      doubt = true;
      return height_sign(ray_, direction_, v, static_cast<float>(t)) * orientation;
    };
    meets = side_of(tmin_) >= 0 && (!bounded_ || side_of(tmax_) <= 0);
  }
  counts_.summed += doubt ? 1 : 0;
  return meets;
}

bool RayOracle::box_of_triangle_is_met(const Vec3 (&v)[3]) const {
  Vec3 lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = std::min({v[0][axis], v[1][axis], v[2][axis]});
    hi[axis] = std::max({v[0][axis], v[1][axis], v[2][axis]});
  }
  const int sign = box_sign(lo, hi);
  return sign == kDoubt ? box_by_sums(lo, hi) : sign > 0;
}

int RayOracle::box_sign(const Vec3& lo, const Vec3& hi) const {
  double entry = tmin_, exit = tmax_;
  const double o[3] = {origin_.x, origin_.y, origin_.z}, d[3] = {direction_.x, direction_.y, direction_.z};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = lo[axis], high = hi[axis];
    if (!(low <= high)) return -1;
    if (d[axis] == 0) {
      if (o[axis] < low || o[axis] > high) return -1;
      continue;
    }
    entry = std::max(entry, ((d[axis] > 0 ? low : high) - o[axis]) / d[axis]);
    exit = std::min(exit, ((d[axis] > 0 ? high : low) - o[axis]) / d[axis]);
  }
  // The ray moves along some axis, so the exit is finite. A quotient is off by its difference's and its own rounding,
  // and so are the largest and the smallest of several.
  const double room = exit - entry;
  if (std::fabs(room) > kBound * (std::fabs(entry) + std::fabs(exit))) return room > 0 ? 1 : -1;
  return kDoubt;
}

bool RayOracle::box_by_sums(const Vec3& lo, const Vec3& hi) const {
  const Vec3 &o = ray_.origin, &d = ray_.direction;
  const auto product = [](float a, float b) { return static_cast<double>(a) * b; };
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0) continue;  // box_sign has looked
    const float near = d[i] > 0 ? lo[i] : hi[i], far = d[i] > 0 ? hi[i] : lo[i];
    const auto past = [&](float plane, float t) {  // sign of (plane - o) / d - t
      ExactSum sum;
      sum.add(plane);
      sum.add(-static_cast<double>(o[i]));
      sum.add(-product(t, d[i]));
      return d[i] > 0 ? sum.sign() : -sum.sign();
    };
    if (past(far, ray_.tmin) < 0 || (bounded_ && past(near, ray_.tmax) > 0)) return false;
    for (int j = 0; j < 3; ++j) {
      if (j == i || d[j] == 0) continue;
      const float exit = d[j] > 0 ? hi[j] : lo[j];
      ExactSum sum;  // (near - o_i) d_j - (exit - o_j) d_i
      sum.add(product(near, d[j]));
      sum.add(-product(o[i], d[j]));
      sum.add(-product(exit, d[i]));
      sum.add(product(o[j], d[i]));
      if (sum.sign() * ((d[i] > 0) == (d[j] > 0) ? 1 : -1) > 0) return false;
    }
  }
  return true;
}

bool RayOracle::meets_box(const Vec3& lo, const Vec3& hi) {
  ++counts_.asked;
  const int sign = box_sign(lo, hi);
  if (sign != kDoubt) return sign > 0;
  ++counts_.summed;
  return box_by_sums(lo, hi);
}

int RayOracle::sphere_sign(const Vec3& centre, float radius) const {
  const Vector f{origin_.x - centre.x, origin_.y - centre.y, origin_.z - centre.z};
  const Vector& d = direction_;
  const double square = static_cast<double>(radius) * radius;
  const auto difference = [](double a, double b) { return Estimate{a - b, std::fabs(a) + std::fabs(b)}; };
  const Estimate off[3] = {difference(f.y * d.z, f.z * d.y), difference(f.z * d.x, f.x * d.z),
                           difference(f.x * d.y, f.y * d.x)};
  Estimate inside{square * (d.x * d.x + d.y * d.y + d.z * d.z), 0};  // r^2 |d|^2 - |(o - c) x d|^2
  inside.magnitude = inside.value;
  for (const Estimate& part : off) {
    inside.value -= part.value * part.value;
    inside.magnitude += part.magnitude * part.magnitude;
  }
  if (inside.sign() != 1) return inside.sign() < 0 ? -1 : kDoubt;
  const auto outside_at = [&](double t) {  // |o + t d - c|^2 - r^2
    Estimate sum{-square, square};
    for (const auto& [from, along] : {std::pair{f.x, d.x}, std::pair{f.y, d.y}, std::pair{f.z, d.z}}) {
      const double at = from + t * along, most = std::fabs(from) + std::fabs(t * along);
      sum.value += at * at;
      sum.magnitude += most * most;
    }
    return sum.sign();
  };
  const auto leaving_at = [&](double t) {  // the slope of the same
    Estimate sum{0, 0};
    for (const auto& [from, along] : {std::pair{f.x, d.x}, std::pair{f.y, d.y}, std::pair{f.z, d.z}}) {
      sum.value += from * along + t * along * along;
      sum.magnitude += std::fabs(from * along) + std::fabs(t) * along * along;
    }
    return sum.sign();
  };
  const int first = outside_at(tmin_), last = bounded_ ? outside_at(tmax_) : 1;
  if (first == kDoubt || last == kDoubt) return kDoubt;
  if (first == 0 || last == 0 || first != last) return 1;
  if (first < 0) return -1;  // all of it is inside the ball
  const int at_first = leaving_at(tmin_), at_last = bounded_ ? leaving_at(tmax_) : 1;
  if (at_first == kDoubt || at_last == kDoubt) return kDoubt;
  return at_first < 0 && at_last > 0 ? 1 : -1;
}

bool RayOracle::meets_sphere(const Vec3& centre, float radius) {
  ++counts_.asked;
  const int sign = sphere_sign(centre, radius);
  if (sign != kDoubt) return sign > 0;
  ++counts_.rational;
  return exact_ray_sphere(ray_, centre, radius, ray_.tmin, ray_.tmax).hit;
}

}  // namespace ctu::oracle
