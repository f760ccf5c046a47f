// Rays that must cross a closed mesh, against all of its triangles: none may leak, neither by the triangle test alone
// nor when each triangle stands behind the tightest box there is, its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "model/intersect/slab_test.h"
#include "model/intersect/triangle_test.h"
#include "tests/oracle/seed.h"
#include "tests/support/closed_meshes.h"

namespace ctu::intersect {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kRaysPerFamily = 500;

struct ClosedMesh {
  scene::Mesh mesh;
  Vec3 middle;  ///< well inside
  double size;  ///< about the distance from there to the surface
};

/// Four triangles' own boxes side by side.
std::vector<Box4> own_boxes(const scene::Mesh& mesh) {
  std::vector<Box4> boxes((mesh.triangles.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < boxes.size() * kLanes; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      float &lo = boxes[i / kLanes].lo[axis][i % kLanes], &hi = boxes[i / kLanes].hi[axis][i % kLanes];
      lo = kInfinity, hi = -kInfinity;
      if (i >= mesh.triangles.size()) continue;
      for (const std::uint32_t v : mesh.triangles[i]) {
        lo = std::min(lo, mesh.vertices[v][axis]);
        hi = std::max(hi, mesh.vertices[v][axis]);
      }
    }
  }
  return boxes;
}

enum class Family { InsideOut, Far4, Far6, Outside, AxisParallel, OneZero, Tiny, Subnormal, Scale1em10, Scale1e10 };
constexpr Family kFamilies[] = {Family::InsideOut,    Family::Outside,  Family::Far4, Family::Far6,
                                Family::AxisParallel, Family::OneZero,  Family::Tiny, Family::Subnormal,
                                Family::Scale1em10,   Family::Scale1e10};
const char* const kFamilyNames[] = {"inside-out",      "far 1e4",       "far 1e6",        "outside",
                                    "axis-parallel",   "one zero",      "tiny component", "subnormal component",
                                    "direction 1e-10", "direction 1e10"};

class AimedRays {
 public:
  AimedRays(const ClosedMesh& closed, std::uint64_t seed) : closed_(closed), random_(seed) {}

  /// Aimed at a vertex or a point of an edge, and passing the middle closely enough to cross the mesh whatever happens.
  Ray next(Family family) {
    const Vec3 target = surface_point(), middle = near_middle();
    Ray ray;
    ray.tmax = kInfinity;
    const double reach = family == Family::Far4 ? 1e4 : family == Family::Far6 ? 1e6 : 3;
    const bool along_axis = family == Family::AxisParallel || family == Family::OneZero || family == Family::Tiny ||
                            family == Family::Subnormal;
    const int zero_axis = static_cast<int>(random_() % 3), long_axis = (zero_axis + 1) % 3;
    for (int axis = 0; axis < 3; ++axis) {
      if (family == Family::InsideOut || along_axis) {
        ray.origin[axis] = middle[axis];
        ray.direction[axis] = target[axis] - middle[axis];
      } else {
        const double inward = static_cast<double>(middle[axis]) - target[axis];
        ray.origin[axis] = static_cast<float>(target[axis] - reach * inward);
        ray.direction[axis] = target[axis] - ray.origin[axis];
      }
    }
    if (along_axis) bend(ray, target, family, zero_axis, long_axis);
    const float scale = family == Family::Scale1em10 ? 1e-10f : family == Family::Scale1e10 ? 1e10f : 1.0f;
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] *= scale;
    return ray;
  }

 private:
  double uniform(double from, double to) { return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53; }

  Vec3 surface_point() {
    const auto& mesh = closed_.mesh;
    const auto& triangle = mesh.triangles[random_() % mesh.triangles.size()];
    const std::size_t corner = random_() % 3;
    const Vec3 a = mesh.vertices[triangle[corner]], b = mesh.vertices[triangle[(corner + 1) % 3]];
    if (random_() % 2) return a;
    const double w = uniform(0, 1);
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(a[axis] + w * (double(b[axis]) - a[axis]));
    return point;
  }

  Vec3 near_middle() {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = static_cast<float>(closed_.middle[axis] + closed_.size * uniform(-0.2, 0.2));
    return point;
  }

  /// From inside along one axis, through the lattice planes of a surface point; other components zero or tiny.
  void bend(Ray& ray, const Vec3& target, Family family, int zero_axis, int long_axis) {
    const double size = closed_.size;
    for (int axis = 0; axis < 3; ++axis) {
      const bool close = std::fabs(static_cast<double>(target[axis]) - closed_.middle[axis]) < 0.5 * size;
      if (axis == zero_axis || family != Family::OneZero) ray.origin[axis] = close ? target[axis] : ray.origin[axis];
      const float sign = random_() % 2 ? 1.0f : -1.0f;
      float small = sign * 0.0f;
      if (family == Family::Tiny) small = sign * static_cast<float>(size * std::pow(10.0, uniform(-30, -8)));
      if (family == Family::Subnormal) small = sign * static_cast<float>(uniform(0, 1e-38));
      if (axis == zero_axis || (family != Family::OneZero && axis != long_axis)) ray.direction[axis] = small;
      if (axis == long_axis) ray.direction[axis] = sign * static_cast<float>(size);
    }
  }

  const ClosedMesh& closed_;
  std::mt19937_64 random_;
};

struct Crossing {
  bool by_triangles = false, behind_boxes = false;
};

Crossing cross(const ClosedMesh& closed, const std::vector<Box4>& boxes, const Ray& ray) {
  const PreparedRay prepared = prepare_ray(ray);
  EXPECT_TRUE(prepared.valid);
  Crossing crossing;
  SlabTimes times;
  for (std::size_t i = 0; i < closed.mesh.triangles.size(); ++i) {
    if (i % kLanes == 0) slab_test_outer(prepared, boxes[i / kLanes], ray.tmax, times);
    const auto& [a, b, c] = closed.mesh.triangles[i];
    const auto& v = closed.mesh.vertices;
    if (!triangle_test(prepared, v[a], v[b], v[c], ray.tmax).hit) continue;
    crossing.by_triangles = true;
    crossing.behind_boxes = crossing.behind_boxes || (times.hit >> (i % kLanes) & 1);
  }
  return crossing;
}

void expect_no_leak(const std::string& name, const ClosedMesh& closed) {
  SCOPED_TRACE(oracle::seed_note());
  const std::vector<Box4> boxes = own_boxes(closed.mesh);
  AimedRays source(closed, oracle::test_seed());
  int leaks_alone = 0, leaks_behind_boxes = 0, rays = 0;
  for (const Family family : kFamilies) {
    for (int i = 0; i < kRaysPerFamily; ++i, ++rays) {
      const Ray ray = source.next(family);
      const Crossing crossing = cross(closed, boxes, ray);
      leaks_alone += !crossing.by_triangles;
      leaks_behind_boxes += !crossing.behind_boxes;
      EXPECT_TRUE(crossing.behind_boxes) << name << ", " << kFamilyNames[static_cast<int>(family)] << ", ray " << i;
    }
  }
  std::printf("%s: %zu triangles, %d aimed rays, leaks %d by triangles alone, %d behind boxes\n", name.c_str(),
              closed.mesh.triangles.size(), rays, leaks_alone, leaks_behind_boxes);
  EXPECT_EQ(leaks_alone, 0);
}

ClosedMesh scaled(ClosedMesh closed, float factor) {
  for (Vec3& v : closed.mesh.vertices) v = {v.x * factor, v.y * factor, v.z * factor};
  closed.size *= factor;
  return closed;
}

const Vec3 kFarAway{1000, 2000, -3000};

ClosedMesh sphere() { return {test::icosphere(3), {0, 0, 0}, 0.98}; }
ClosedMesh cube() { return {test::lattice_cube(10), {0, 0, 0}, 1}; }
ClosedMesh moved(const ClosedMesh& closed) { return {test::moved(closed.mesh, kFarAway), kFarAway, closed.size}; }

TEST(Watertight, a_sphere_leaks_no_aimed_ray) { expect_no_leak("sphere", sphere()); }
TEST(Watertight, a_lattice_cube_leaks_no_aimed_ray) { expect_no_leak("cube", cube()); }
TEST(Watertight, a_sphere_far_away_leaks_no_aimed_ray) { expect_no_leak("moved sphere", moved(sphere())); }
TEST(Watertight, a_lattice_cube_far_away_leaks_no_aimed_ray) { expect_no_leak("moved cube", moved(cube())); }
TEST(Watertight, a_tiny_sphere_leaks_no_aimed_ray) { expect_no_leak("sphere of size 1e-15", scaled(sphere(), 1e-15f)); }
TEST(Watertight, a_tiny_cube_leaks_no_aimed_ray) { expect_no_leak("cube of size 1e-30", scaled(cube(), 1e-30f)); }
TEST(Watertight, a_huge_sphere_leaks_no_aimed_ray) { expect_no_leak("sphere of size 1e15", scaled(sphere(), 1e15f)); }
TEST(Watertight, a_huge_cube_leaks_no_aimed_ray) { expect_no_leak("cube of size 1e27", scaled(cube(), 1e27f)); }

}  // namespace
}  // namespace ctu::intersect
