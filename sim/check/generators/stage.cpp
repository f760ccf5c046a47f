#include "sim/check/generators/stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/numeric/round.h"

namespace ctu::sim::check {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kMost = std::numeric_limits<float>::max();

/// The binary exponent of the largest component, of a direction in space.
int largest_exponent(const double (&d)[3]) {
  const double most = std::max({std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])});
  return most == 0 ? 0 : std::ilogb(most);
}

}  // namespace

double axis_of(const Vector64& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
double& axis_of(Vector64& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

float to_finite(double x) { return static_cast<float>(std::clamp(x, -kMost, kMost)); }

float moved_by_ulps(float x, int steps) {
  for (; steps > 0; --steps) x = numeric::next_up(x);
  for (; steps < 0; ++steps) x = numeric::next_down(x);
  return to_finite(x);
}

Vec3 Frame::point(const Vector64& u) const {
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = to_finite(std::ldexp(axis_of(u, a) + offset[a], exponent[a]));
  return p;
}

void Stage::triangle(const Corners& corners) {
  const auto first = static_cast<std::uint32_t>(out_.mesh.vertices.size());
  for (const Vector64& corner : {corners.a, corners.b, corners.c}) {
    corners_.push_back(corner);
    out_.mesh.vertices.push_back(frame_.point(corner));
  }
  out_.mesh.triangles.push_back({first, first + 1, first + 2});
}

Vector64 Stage::vertex() {
  const int triangle = random_.below(triangles());
  return corner(triangle, random_.below(3));
}

Vector64 Stage::edge_point() {
  const int triangle = random_.below(triangles()), i = random_.below(3);
  const Vector64 &a = corner(triangle, i), &b = corner(triangle, (i + 1) % 3);
  // Often where the edge crosses a border of cells, if it goes from face to face of a block.
  const int parts = random_.pick(2, 8);
  return random_.chance(0.5) ? a + (b - a) * random_.unit() : a + (b - a) * random_.pick(0, parts) * (1.0 / parts);
}

Vector64 Stage::inner_point() {
  const int triangle = random_.below(triangles());
  double u = random_.unit(), v = random_.unit();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const Vector64& a = corner(triangle, 0);
  return a + (corner(triangle, 1) - a) * u + (corner(triangle, 2) - a) * v;
}

Vector64 Stage::surface_point() {
  switch (random_.below(4)) {
    case 0:
      return vertex();
    case 1:
      return edge_point();
    default:
      return inner_point();
  }
}

void Stage::ray(const Aim& aim) {
  const Vec3 from = frame_.point(aim.origin), to = frame_.point(aim.target);
  double d[3];
  for (int a = 0; a < 3; ++a) d[a] = static_cast<double>(to[a]) - from[a];
  if (d[0] == 0 && d[1] == 0 && d[2] == 0) d[random_.below(3)] = std::ldexp(1.0, frame_.exponent[0]);
  // Neither all of it beyond the largest number nor all of it below the smallest.
  const int exponent = std::clamp(aim.exponent, -149 - largest_exponent(d), 126 - largest_exponent(d));
  Vec3 direction;
  for (int a = 0; a < 3; ++a) direction[a] = to_finite(std::ldexp(d[a], exponent));
  ray_along(aim.origin, direction, std::ldexp(1.0, -exponent), aim.mix);
}

void Stage::ray_along(const Vector64& origin, const Vec3& direction, double time, RangeMix mix) {
  intersect::Ray ray;
  ray.origin = frame_.point(origin);
  for (int a = 0; a < 3; ++a)
    ray.direction[a] = direction[a] == 0 ? static_cast<float>(random_.either_sign(0.0)) : direction[a];
  if (!(ray.direction.x != 0 || ray.direction.y != 0 || ray.direction.z != 0)) ray.direction.x = 1;
  ray.kind = random_.chance(0.3) ? intersect::RayKind::AnyHit : intersect::RayKind::ClosestHit;
  set_range(ray, time, mix);
  out_.rays.push_back(ray);
}

void Stage::set_range(intersect::Ray& ray, double time, RangeMix mix) {
  const float at = to_finite(time);
  ray.tmin = 0;
  ray.tmax = kInfinity;
  if (mix == RangeMix::Open || (mix == RangeMix::Any && random_.chance(0.5))) return;
  if (mix == RangeMix::AtPoint) {
    ray.tmin = ray.tmax = at;
    return;
  }
  const float near = moved_by_ulps(at, random_.pick(-1, 1));
  switch (random_.below(mix == RangeMix::Ends ? 4 : 8)) {
    case 0:
    case 1:
      ray.tmax = std::max(near, 0.0f);
      break;
    case 2:
      ray.tmin = near;
      break;
    case 3:
      ray.tmin = to_finite(time * random_.unit());
      ray.tmax = std::max(near, ray.tmin);
      break;
    case 4:
      ray.tmax = std::max(at, to_finite(time * random_.between(1, 2)));
      break;
    case 5:
      ray.tmin = to_finite(time * random_.unit());
      break;
    case 6:
      ray.tmin = to_finite(time * random_.between(0.9, 1));
      ray.tmax = std::max(at, to_finite(time * random_.between(1, 1.1)));
      break;
    default:
      ray.tmin = to_finite(-time * random_.unit());
  }
}

void Stage::nudge(int most) {
  intersect::Ray& ray = out_.rays.back();
  for (int a = 0; a < 3; ++a) {
    if (random_.chance(0.5)) ray.origin[a] = moved_by_ulps(ray.origin[a], random_.pick(-most, most));
    if (random_.chance(0.5) && ray.direction[a] != 0)
      ray.direction[a] = moved_by_ulps(ray.direction[a], random_.pick(-most, most));
  }
  if (!intersect::is_valid(ray)) ray.direction.x = 1;
}

Vector64 point_in_block(CaseRandom& random, const Vector64& at, double side) {
  return at + each_axis([&] { return random.below(kSide + 1); }) * (side / kSide);
}

Vector64 cell_corner(CaseRandom& random, const Vector64& at, double side) {
  const int r = random.pick(2, 8);
  return at + each_axis([&] { return random.pick(0, r); }) * (side / r);
}

namespace {

/// A thin triangle along a diagonal of the block: all of its bounds.
void add_strut(Stage& stage, const Vector64& at) {
  CaseRandom& random = stage.random();
  Vector64 from = at, to = at;
  for (int a = 0; a < 3; ++a) axis_of(random.chance(0.5) ? from : to, a) += kSide;
  const double thickness = std::ldexp(1.0, random.pick(0, 7));
  const Vector64 middle = from + (to - from) * (random.pick(1, 7) * 0.125);
  const Vector64 across = each_axis([&] { return random.pick(-1, 1); });
  stage.triangle({from, to, middle + across * thickness});
}

}  // namespace

std::vector<Vector64> add_blocks(Stage& stage, int least, int most) {
  CaseRandom& random = stage.random();
  std::vector<Vector64> blocks;
  const int count = random.pick(least, most);
  for (int i = 0; i < count; ++i) {
    const Vector64 at = each_axis([&] { return random.pick(0, 3); }) * kSide;
    blocks.push_back(at);
    add_strut(stage, at);
    for (int more = random.below(4); more > 0; --more) {
      if (random.chance(0.3))
        add_strut(stage, at);
      else
        stage.triangle({cell_corner(random, at), cell_corner(random, at), cell_corner(random, at)});
    }
  }
  return blocks;
}

Vector64 outside_point(CaseRandom& random) {
  Vector64 point;
  for (int a = 0; a < 3; ++a) axis_of(point, a) = random.pick(-8 * kSide, 12 * kSide);
  axis_of(point, random.below(3)) = random.chance(0.5) ? -random.pick(1, 4) * kSide : random.pick(5, 9) * kSide;
  return point;
}

}  // namespace ctu::sim::check
