// The fast tracer and the reference traversal beside Embree in robust mode, on generated and on real scenes. Two
// rounded tests differ where a ray grazes an edge or lies almost in a triangle's plane; there the exact oracle judges.
// A triangle that it says is hit may be missing from ours only where triangle_test, asked about it alone, rounds the
// ray past a free edge or puts its t farther away (closed meshes stay closed): the boxes in front must not lose what
// triangle_test accepts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "model/accel/build.h"
#include "model/intersect/triangle_test.h"
#include "model/numeric/round.h"
#include "model/reference/closest_hit.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"
#include "tests/reference/embree_scene.h"
#include "tests/reference/rays.h"
#include "tests/support/real_scenes.h"

namespace {

using namespace ctu;
using intersect::Hit;
using intersect::Ray;

constexpr double kRelativeTolerance = 2e-5;   // of the farthest coordinate the ray works with, in units of t
constexpr double kGrazingDistance = 0x1p-18;  // of the same; triangle_test's shear is good to 6.1 * 2^-24
constexpr double kGrazingSine = 1e-3;         // of the angle between ray and plane

bool is_hit(const Hit& hit) { return hit.primitive != intersect::kNoPrimitive; }

std::string describe(const Ray& ray, const Hit& ours, const Hit& theirs) {
  std::string text = "ray bits";
  for (const float f : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z})
    text += " " + std::to_string(numeric::bits(f));
  return text + "\nours t " + std::to_string(ours.t) + " primitive " + std::to_string(ours.primitive) + ", Embree t " +
         std::to_string(theirs.t) + " primitive " + std::to_string(theirs.primitive);
}

struct Double3 {
  double x, y, z;
};
Double3 between(const Vec3& a, const Vec3& b) {
  return {static_cast<double>(b.x) - a.x, static_cast<double>(b.y) - a.y, static_cast<double>(b.z) - a.z};
}
Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Double3& a) { return std::sqrt(dot(a, a)); }
Double3 minus(const Double3& a, const Double3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Double3 times(double s, const Double3& a) { return {s * a.x, s * a.y, s * a.z}; }

/// Of the origin.
double distance_to_segment(const Double3& a, const Double3& b) {
  const Double3 along = minus(b, a);
  const double squared = dot(along, along);
  const double at = squared == 0 ? 0 : std::clamp(-dot(a, along) / squared, 0.0, 1.0);
  return length(minus(a, times(-at, along)));
}

class Comparison {
 public:
  explicit Comparison(const scene::Scene& scene)
      : scene_(scene),
        bvh_(accel::build(scene.mesh, {})),
        tracer_(bvh_),
        traversal_(bvh_, nullptr, no_culling_),
        embree_(scene.mesh, true) {
    embree_.commit();
  }

  const reference::FastTracer& tracer() const { return tracer_; }

  void check(const std::vector<Ray>& rays) {
    for (const Ray& ray : rays) {
      const Hit ours = tracer_.closest(ray), theirs = embree_.closest(ray);
      ++rays_;
      hits_ += is_hit(ours);
      expect_the_reference_agrees(ray, ours);
      if (agree(ray, ours, theirs)) continue;
      ++disagreements_;
      judge(ray, ours, theirs);
      if (testing::Test::HasFailure()) return;
    }
  }

  /// Of ordinary rays hardly any grazes an edge.
  void expect_near_agreement() const {
    EXPECT_GT(hits_, rays_ / 100) << "there must be something to agree on";
    EXPECT_LE(disagreements_, rays_ / 1000);
  }

  void record() const {
    testing::Test::RecordProperty("rays", std::to_string(rays_));
    testing::Test::RecordProperty("hits", std::to_string(hits_));
    testing::Test::RecordProperty("disagreements", std::to_string(disagreements_));
  }

 private:
  /// The reference's exact boxes may skip what only rounding hits: a triangle that the ray grazes.
  void expect_the_reference_agrees(const Ray& ray, const Hit& ours) const {
    const Hit walked = traversal_.trace(ray);
    if (same_bits(ours, walked)) return;
    EXPECT_TRUE(is_hit(ours) && grazes(ray, ours.primitive)) << "the reference differs\n"
                                                             << describe(ray, walked, ours);
  }

  /// The largest coordinate of a vertex, seen from the origin.
  double reach(const Ray& ray) const {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double o = ray.origin[axis];
      reach = std::max({reach, std::fabs(scene_.lower[axis] - o), std::fabs(scene_.upper[axis] - o)});
    }
    return reach;
  }

  /// What rounding may move t by.
  double tolerance(const Ray& ray) const {
    const Vec3& d = ray.direction;
    return kRelativeTolerance * reach(ray) / std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
  }

  bool agree(const Ray& ray, const Hit& ours, const Hit& theirs) const {
    if (is_hit(ours) != is_hit(theirs)) return false;
    return !is_hit(ours) || std::fabs(static_cast<double>(ours.t) - theirs.t) <= tolerance(ray);
  }

  Vec3 corner(std::uint32_t primitive, int i) const {
    return scene_.mesh.vertices[scene_.mesh.triangles[primitive][static_cast<std::size_t>(i)]];
  }

  oracle::ExactTriangleHit exact(const Ray& ray, std::uint32_t primitive) const {
    return oracle::exact_ray_triangle(ray, corner(primitive, 0), corner(primitive, 1), corner(primitive, 2), ray.tmin,
                                      ray.tmax);
  }

  void judge(const Ray& ray, const Hit& ours, const Hit& theirs) const {
    const std::string what = describe(ray, ours, theirs);
    if (is_hit(theirs) && (!is_hit(ours) || theirs.t < ours.t)) {
      const std::uint32_t primitive = theirs.primitive;
      const auto alone = intersect::triangle_test(intersect::prepare_ray(ray), corner(primitive, 0),
                                                  corner(primitive, 1), corner(primitive, 2), ray.tmax);
      EXPECT_FALSE(alone.hit && intersect::replaces(alone.t, primitive, ours)) << "ours lost a hit on the way\n"
                                                                               << what;
      EXPECT_TRUE(!exact(ray, primitive).hit || grazes(ray, primitive)) << "ours missed a true hit\n" << what;
    } else {
      EXPECT_TRUE(exact(ray, ours.primitive).hit || grazes(ray, ours.primitive)) << "ours hit nothing\n" << what;
    }
  }

  /// Whether rounding may decide between hit and miss: seen along the ray, the triangle has an edge within the
  /// rounding of its coordinates of it; or the ray lies nearly in the triangle's plane.
  bool grazes(const Ray& ray, std::uint32_t primitive) const {
    const Double3 d{ray.direction.x, ray.direction.y, ray.direction.z};
    Double3 seen[3];
    for (int i = 0; i < 3; ++i) {
      const Double3 p = between(ray.origin, corner(primitive, i));
      seen[i] = minus(p, times(dot(p, d) / dot(d, d), d));
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) nearest = std::min(nearest, distance_to_segment(seen[i], seen[(i + 1) % 3]));
    const Vec3 v0 = corner(primitive, 0);
    const Double3 normal = cross(between(v0, corner(primitive, 1)), between(v0, corner(primitive, 2)));
    return nearest <= kGrazingDistance * reach(ray) ||
           std::fabs(dot(normal, d)) <= kGrazingSine * length(normal) * length(d);
  }

  const scene::Scene& scene_;
  accel::Bvh4 bvh_;
  reference::FastTracer tracer_;
  cull::MaskTester no_culling_{cull::Design::None, {}};
  reference::Traversal traversal_;
  test::EmbreeScene embree_;
  std::size_t rays_ = 0, hits_ = 0, disagreements_ = 0;
};

void compare(const scene::Scene& scene) {
  SCOPED_TRACE(oracle::seed_note());
  Comparison comparison(scene);
  const std::vector<Ray> primary = test::primary_rays(scene, 160, 120);
  comparison.check(primary);
  comparison.check(test::diffuse_rays(scene, comparison.tracer(), primary, oracle::test_seed()));
  comparison.check(test::random_rays(scene, 15000, oracle::test_seed()));
  comparison.expect_near_agreement();
  comparison.check(test::aimed_rays(scene, 5000, oracle::test_seed()));
  comparison.record();
}

class GeneratedScene : public testing::TestWithParam<const char*> {};

TEST_P(GeneratedScene, is_hit_as_by_embree_or_the_exact_oracle_says_why_not) { compare(scene::load(GetParam())); }

INSTANTIATE_TEST_SUITE_P(EmbreeHits, GeneratedScene,
                         testing::Values("gen:hair-ball", "gen:curly-hair?strands=500", "gen:straight-hair",
                                         "gen:tilted-quads", "gen:foliage", "gen:tetra?depth=7"));

class RealScene : public testing::TestWithParam<const char*> {};

TEST_P(RealScene, is_hit_as_by_embree_or_the_exact_oracle_says_why_not) {
  const std::filesystem::path folder = test::unpacked_scenes();
  if (folder.empty()) GTEST_SKIP() << "no shared scenes: set CTU_SCENES to their folder";
  compare(scene::load((folder / GetParam()).string()));
}

INSTANTIATE_TEST_SUITE_P(EmbreeHits, RealScene,
                         testing::Values("bunny/bunny.ply.zst", "buddha/buddha.ply.zst", "sponza/sponza.obj.zst",
                                         "tetra/tetra.nff", "small-pine/scene.gltf",
                                         "dutch-ship/dutch_ship_medium_1k.gltf", "straight-hair/straight.hair.zst",
                                         "ratboy-mohawk/Ratboy_mohawk.tfx.zst", "kitchen/scene.pbrt",
                                         "bathroom/bathroom.pbrt", "breakfast/breakfast.pbrt",
                                         "classroom/classroom.scn", "coffee-maker/scene.pbrt",
                                         "san-miguel/san-miguel.list"));

}  // namespace
