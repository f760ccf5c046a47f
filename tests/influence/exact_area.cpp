#include "tests/influence/exact_area.h"

#include <algorithm>

#include "tests/oracle/rational.h"

namespace ctu::test {
namespace {

using influence::AreaKind;
using influence::InfluenceArea;
using influence::Point2;
using oracle::Rational;
using oracle::Vec3q;
using oracle::operator-;
using Polygon3 = std::vector<Vec3q>;

/// The points with normal . q <= offset.
struct HalfSpace {
  Vec3q normal;
  Rational offset;
  Rational beyond(const Vec3q& q) const { return oracle::dot(normal, q) - offset; }
};

Vec3q local_direction(const InfluenceArea& area, const Vec3q& d) {
  return {oracle::dot(oracle::exact(area.axes[0]), d), oracle::dot(oracle::exact(area.axes[1]), d),
          oracle::dot(oracle::exact(area.axes[2]), d)};
}

Vec3q local(const InfluenceArea& area, const Vec3q& p) { return local_direction(area, p - oracle::exact(area.origin)); }

std::vector<HalfSpace> half_spaces(const InfluenceArea& area) {
  const Rational x = oracle::exact(area.half_x), y = oracle::exact(area.half_y);
  const bool converges = area.kind == AreaKind::Point;
  std::vector<HalfSpace> all{{{0, 0, -1}, -oracle::exact(area.near)}, {{0, 0, 1}, oracle::exact(area.far)}};
  for (const int side : {-1, 1}) {
    all.push_back({{side, 0, converges ? Rational(-x) : Rational(0)}, converges ? Rational(0) : x});
    all.push_back({{0, side, converges ? Rational(-y) : Rational(0)}, converges ? Rational(0) : y});
  }
  return all;
}

bool inside(const std::vector<HalfSpace>& body, const Vec3q& q) {
  return std::all_of(body.begin(), body.end(), [&](const HalfSpace& h) { return h.beyond(q) <= 0; });
}

/// Whether a closed polygon has a point in all half-spaces.
bool reaches(Polygon3 polygon, const std::vector<HalfSpace>& body) {
  for (const HalfSpace& h : body) {
    Polygon3 kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3q &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const Rational a = h.beyond(from), b = h.beyond(to);
      if (a <= 0) kept.push_back(from);
      if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
        const Rational share = a / (a - b);
        kept.push_back({from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]),
                        from[2] + share * (to[2] - from[2])});
      }
    }
    polygon = std::move(kept);
  }
  return !polygon.empty();
}

Vec3q corner_of(const Vec3& lower, const Vec3& upper, int corner) {
  Vec3q p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = oracle::exact(((corner >> axis) & 1) != 0 ? upper[axis] : lower[axis]);
  return p;
}

/// The area's middle of the near side, in the world: the axes are inverted by Cramer's rule.
Vec3q a_point_of(const InfluenceArea& area) {
  const Vec3q u = oracle::exact(area.axes[0]), v = oracle::exact(area.axes[1]), w = oracle::exact(area.axes[2]);
  const Vec3q along = oracle::cross(u, v);
  const Rational scale = oracle::exact(area.near) / oracle::dot(along, w);
  const Vec3q o = oracle::exact(area.origin);
  return {o[0] + scale * along[0], o[1] + scale * along[1], o[2] + scale * along[2]};
}

struct Point2q {
  Rational x, y;
};
Point2q exact(const Point2& p) { return {Rational(p.x), Rational(p.y)}; }
Rational turn(const Point2q& a, const Point2q& b, const Point2q& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::vector<Point2q> exact(const std::vector<Point2>& polygon) {
  std::vector<Point2q> all;
  for (const Point2& p : polygon) all.push_back(exact(p));
  return all;
}

int side(const std::vector<Point2q>& polygon, const Point2q& p) {
  int least = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    least = std::min(least, sgn(turn(polygon[i], polygon[(i + 1) % polygon.size()], p)));
  return least;
}

/// The crossing of two segments that are not parallel, if there is one.
void add_crossing(const Point2q& a, const Point2q& b, const Point2q& c, const Point2q& d, std::vector<Point2q>& out) {
  const Rational at_a = turn(c, d, a), at_b = turn(c, d, b), at_c = turn(a, b, c), at_d = turn(a, b, d);
  if (at_a == at_b || sgn(at_a) * sgn(at_b) > 0 || sgn(at_c) * sgn(at_d) > 0) return;
  const Rational share = at_a / (at_a - at_b);
  out.push_back({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)});
}

/// In order around the corner with the smallest coordinates.
void sort_around(std::vector<Point2q>& points) {
  const auto first = std::min_element(points.begin(), points.end(), [](const Point2q& a, const Point2q& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  std::swap(points.front(), *first);
  const Point2q pivot = points.front();
  std::sort(points.begin() + 1, points.end(), [&](const Point2q& a, const Point2q& b) {
    const Rational t = turn(pivot, a, b);
    if (t != 0) return t > 0;
    const auto distance = [&](const Point2q& p) { return Rational(abs(p.x - pivot.x) + abs(p.y - pivot.y)); };
    return distance(a) < distance(b);
  });
}

Rational doubled_area(const std::vector<Point2q>& polygon) {
  Rational sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2q &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    sum += p.x * q.y - p.y * q.x;
  }
  return sum;
}

}  // namespace

bool exact_contains(const InfluenceArea& area, const Vec3& point) {
  return inside(half_spaces(area), local(area, oracle::exact(point)));
}

bool exact_contains(const InfluenceArea& area, const intersect::Ray& ray, float t) {
  const Vec3q o = oracle::exact(ray.origin), d = oracle::exact(ray.direction);
  const Rational at = oracle::exact(t);
  return inside(half_spaces(area), local(area, {o[0] + at * d[0], o[1] + at * d[1], o[2] + at * d[2]}));
}

bool exact_touches(const InfluenceArea& area, const Vec3& v0, const Vec3& v1, const Vec3& v2) {
  Polygon3 triangle;
  for (const Vec3& v : {v0, v1, v2}) triangle.push_back(local(area, oracle::exact(v)));
  return reaches(triangle, half_spaces(area));
}

bool exact_touches(const InfluenceArea& area, const Vec3& lower, const Vec3& upper) {
  const std::vector<HalfSpace> body = half_spaces(area);
  constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    Polygon3 polygon;
    for (const int corner : face) polygon.push_back(local(area, corner_of(lower, upper, corner)));
    if (reaches(polygon, body)) return true;
  }
  const Vec3q p = a_point_of(area);
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < oracle::exact(lower[axis]) || p[axis] > oracle::exact(upper[axis])) return false;
  return true;
}

int exact_side(const std::vector<Point2>& polygon, const Point2& point) { return side(exact(polygon), exact(point)); }

double exact_doubled_area(const std::vector<Point2>& polygon) { return doubled_area(exact(polygon)).get_d(); }

double exact_common_area(const std::vector<Point2>& a_in, const std::vector<Point2>& b_in) {
  const std::vector<Point2q> a = exact(a_in), b = exact(b_in);
  std::vector<Point2q> points;
  for (const Point2q& p : a)
    if (side(b, p) >= 0) points.push_back(p);
  for (const Point2q& p : b)
    if (side(a, p) >= 0) points.push_back(p);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      add_crossing(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()], points);
  if (points.size() < 3) return 0;
  sort_around(points);
  return Rational(doubled_area(points) / 2).get_d();
}

}  // namespace ctu::test
