// Trees of influence areas: nothing that touches the area is left out, and heuristics do what they are for.
#include "model/influence/local_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/accel/statistics.h"
#include "model/influence/projected_area.h"
#include "model/intersect/slab_test.h"
#include "model/scene/load.h"
#include "tests/influence/exact_area.h"
#include "tests/influence/random_areas.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using accel::Bvh4;
using influence::AreaKind;
using influence::InfluenceArea;
using influence::ProjectedArea;
using influence::TreeAxes;
using influence::TreeCost;
using influence::TreeHeuristic;

/// Around `scene`, its rays along the z axis.
InfluenceArea along_z(const scene::Scene& scene) {
  InfluenceArea area;
  area.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  area.half_x = std::max(std::fabs(scene.lower.x), std::fabs(scene.upper.x));
  area.half_y = std::max(std::fabs(scene.lower.y), std::fabs(scene.upper.y));
  area.near = scene.lower.z;
  area.far = scene.upper.z;
  return area;
}

/// Small triangles, random in a block of the given extents.
scene::Scene block(const Vec3& extent, int triangles, std::uint64_t seed) {
  test::AreaRandom random(seed);
  scene::Scene scene;
  for (int i = 0; i < triangles; ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.between(-0.5f, 0.5f) * extent[axis];
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 d = random.point(0.03f);
      scene.mesh.vertices.push_back({p.x + d.x, p.y + d.y, p.z + d.z});
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.lower = scene.upper = scene.mesh.vertices[0];
  for (const Vec3& v : scene.mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) {
      scene.lower[axis] = std::min(scene.lower[axis], v[axis]);
      scene.upper[axis] = std::max(scene.upper[axis], v[axis]);
    }
  return scene;
}

/// Boxes and triangles that a lattice of rays along z has on its way, a ray.
double work_along_z(const Bvh4& bvh, const InfluenceArea& area, int side) {
  std::uint64_t work = 0;
  for (int i = 0; i < side * side; ++i) {
    const float x = area.half_x * (2 * (static_cast<float>(i % side) + 0.5f) / static_cast<float>(side) - 1);
    const float y = area.half_y * (2 * (static_cast<float>(i / side) + 0.5f) / static_cast<float>(side) - 1);
    const auto ray = intersect::prepare_ray({{x, y, area.near}, 0, {0, 0, 1}, area.far - area.near});
    std::vector<accel::ChildRef> open{0};
    while (!open.empty()) {
      const accel::ChildRef ref = open.back();
      open.pop_back();
      work += accel::is_leaf(ref) ? static_cast<std::uint64_t>(accel::leaf_count(ref)) : 1;
      if (accel::is_leaf(ref)) continue;
      const unsigned hit = intersect::slab_test(ray, bvh.nodes[ref].boxes, ray.ray.tmax).hit;
      for (int lane = 0; lane < intersect::kLanes; ++lane)
        if ((hit >> lane & 1) != 0) open.push_back(bvh.nodes[ref].child[lane]);
    }
  }
  return double(work) / (side * side);
}

std::vector<std::uint32_t> ids(const Bvh4& bvh) {
  std::vector<std::uint32_t> all;
  for (const accel::LeafTriangle& triangle : bvh.triangles) all.push_back(triangle.primitive);
  return all;
}

TEST(LocalTree, holds_every_triangle_with_a_point_in_the_area_under_the_id_it_has_in_the_scene) {
  SCOPED_TRACE(oracle::seed_note());
  test::AreaRandom random(oracle::test_seed() + 20);
  const scene::Scene scene = scene::load("gen:tilted-quads?quads=600");
  for (int i = 0; i < 8; ++i) {
    const InfluenceArea area = random.area(1, 0.5f);
    const auto inside = influence::primitives_in(scene.mesh, influence::PreparedArea(area), 2);
    std::size_t exact = 0;
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = scene.mesh.triangles[t];
      if (!test::exact_touches(area, scene.mesh.vertices[a], scene.mesh.vertices[b], scene.mesh.vertices[c])) continue;
      ++exact;
      ASSERT_TRUE(std::binary_search(inside.begin(), inside.end(), t)) << "area " << i << " triangle " << t;
    }
    EXPECT_LE(inside.size(), exact + 1);
    if (inside.empty()) continue;
    const Bvh4 bvh = influence::build_for(scene.mesh, inside, area, {}, {});
    std::vector<std::uint32_t> held = ids(bvh);
    std::sort(held.begin(), held.end());
    EXPECT_EQ(held, inside);
    for (const accel::LeafTriangle& triangle : bvh.triangles)
      EXPECT_EQ(triangle.v0, scene.mesh.vertices[scene.mesh.triangles[triangle.primitive][0]]);
  }
}

TEST(LocalTree, holds_every_sphere_with_a_point_in_the_area) {
  SCOPED_TRACE(oracle::seed_note());
  test::AreaRandom random(oracle::test_seed() + 21);
  const scene::Scene scene = scene::load("gen:balls?depth=2");
  const auto triangles = static_cast<std::uint32_t>(scene.mesh.triangles.size());
  std::size_t held = 0;
  for (int i = 0; i < 8; ++i) {
    const InfluenceArea area = random.area(1, 0.5f);
    const influence::PreparedArea prepared(area);
    const auto inside = influence::primitives_in(scene.mesh, prepared, 2);
    for (std::uint32_t s = 0; s < scene.mesh.spheres.size(); ++s) {
      const scene::Sphere& ball = scene.mesh.spheres[s];
      bool point_inside = prepared.certainly_contains(ball.centre);
      for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
          Vec3 pole = ball.centre;
          pole[axis] += side * ball.radius;
          point_inside |= prepared.certainly_contains(pole);
        }
      if (!point_inside) continue;
      ++held;
      ASSERT_TRUE(std::binary_search(inside.begin(), inside.end(), triangles + s)) << "area " << i << " sphere " << s;
    }
    if (inside.empty()) continue;
    const Bvh4 bvh = influence::build_for(scene.mesh, inside, area, {}, {});
    for (const accel::LeafTriangle& primitive : bvh.triangles) {
      ASSERT_EQ(primitive.is_sphere(), primitive.id() >= triangles);
      if (primitive.is_sphere()) {
        EXPECT_EQ(primitive.sphere(), scene.mesh.spheres[primitive.id() - triangles]);
      }
    }
  }
  EXPECT_GT(held, 0u);
}

TEST(Facing, is_the_share_of_the_component_across_the_plane) {
  const auto f = influence::facing(1, -2, 1);
  EXPECT_DOUBLE_EQ(f[0], 0.25);
  EXPECT_DOUBLE_EQ(f[1], 0.5);
  EXPECT_DOUBLE_EQ(f[2], 0.25);
  EXPECT_EQ(influence::facing(0, 0, -3)[2], 1);
  EXPECT_EQ(influence::facing(0, 0, 0)[0], 0);
}

/// A cut with given chances of the children, on every axis.
accel::Cut cut_with(int axis, float children) { return {children, children, 0, axis, 1}; }

TEST(LeastFacingAxes, stops_at_an_excellent_cut_takes_the_best_normal_one_and_else_the_longest_axis) {
  InfluenceArea area;
  area.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  area.half_x = area.half_y = area.far = 1;
  const influence::LeastFacingAxes axes(area, 1, {});
  const accel::Box3 tall{accel::to_vector({0, 0, 0}), accel::to_vector({1, 2, 9})};
  std::vector<int> tried;
  const auto choose = [&](float on_x, float on_y) {
    tried.clear();
    return axes.choose(tall, 1, [&](int axis) {
      tried.push_back(axis);
      return cut_with(axis, axis == 0 ? on_x : axis == 1 ? on_y : 1.0f);
    });
  };
  EXPECT_EQ(choose(0.8f, 0.5f).axis, 0) << "good enough: nothing else is tried";
  EXPECT_EQ(tried, (std::vector<int>{0}));
  EXPECT_EQ(choose(1.2f, 1.1f).axis, 1) << "both normal: the better one";
  EXPECT_EQ(choose(1.2f, 1.5f).axis, 0) << "the second is hopeless";
  EXPECT_EQ(choose(1.5f, 1.5f).axis, 2) << "all hopeless: the longest axis, though it faces the rays";
  EXPECT_EQ(tried, (std::vector<int>{0, 1, 2}));
}

TEST(LeastFacingAxes, of_a_point_area_faces_the_ray_through_the_middle_of_the_box) {
  InfluenceArea area;
  area.kind = AreaKind::Point;
  area.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  area.half_x = area.half_y = area.far = 4;
  area.origin = {1, 2, 3};
  const influence::LeastFacingAxes axes(area, 0.5, {});
  const auto first = [&](const Vec3& middle) {
    const Vec3 m{0.5f * middle.x, 0.5f * middle.y, 0.5f * middle.z};  // the builder's coordinates
    const accel::Box3 box{accel::to_vector({m.x - 1, m.y - 1, m.z - 1}), accel::to_vector({m.x + 1, m.y + 1, m.z + 1})};
    return axes.choose(box, 1, [](int axis) { return cut_with(axis, 0.5f); }).axis;
  };
  EXPECT_EQ(first({9, 4, 2}), 2);
  EXPECT_EQ(first({1.5f, 6, 9}), 0);
  EXPECT_EQ(first({7, 2.5f, 9}), 1);
}

TEST(LocalTree, split_along_the_rays_costs_less_where_a_block_is_long_along_them) {
  const scene::Scene scene = block({1, 1, 3}, 3000, oracle::test_seed());
  const InfluenceArea area = along_z(scene);
  const auto work = [&](const TreeHeuristic& h) {
    return work_along_z(influence::build_for(scene.mesh, area, h, {}), area, 40);
  };
  const double longest = work({TreeCost::SurfaceArea, TreeAxes::Longest});
  EXPECT_LT(work({TreeCost::SurfaceArea, TreeAxes::LeastFacing, influence::FacingThresholds{}}), longest);
  EXPECT_LT(work({TreeCost::ProjectedArea, TreeAxes::All}), longest);
}

TEST(LocalTree, projected_areas_predict_its_cost_for_affine_rays_and_surface_areas_do_not) {
  const scene::Scene scene = block({1, 1, 3}, 2000, oracle::test_seed() + 1);
  const InfluenceArea area = along_z(scene);
  for (const TreeAxes axes : {TreeAxes::Longest, TreeAxes::LeastFacing}) {
    const Bvh4 bvh = influence::build_for(scene.mesh, area, {TreeCost::SurfaceArea, axes}, {});
    const double measured = work_along_z(bvh, area, 64);
    const ProjectedArea projected(area);
    const auto by = [&](const auto& chance) { return accel::expected_work(bvh, chance).intersections(); };
    const double by_projection = by([&](const Vec3& l, const Vec3& u) { return projected.share(l, u); });
    const double root = accel::surface_area(bvh.lower, bvh.upper);
    const double by_surface = by([&](const Vec3& l, const Vec3& u) { return accel::surface_area(l, u) / root; });
    EXPECT_NEAR(by_projection / measured, 1, 0.02);
    EXPECT_GT(std::fabs(by_surface / measured - 1), 0.1);
    EXPECT_NEAR(by_surface, accel::statistics(bvh).sah_cost, 1e-9 * by_surface);
  }
}

TEST(LocalTree, by_a_mixed_cost_ranges_from_projected_to_surface_area) {
  const scene::Scene scene = block({1, 1, 1}, 700, oracle::test_seed() + 2);
  const InfluenceArea area = along_z(scene);
  const auto order = [&](TreeCost cost, double part) {
    return ids(influence::build_for(scene.mesh, area, {cost, TreeAxes::All, {}, part}, {}));
  };
  EXPECT_EQ(order(TreeCost::Mixed, 0), order(TreeCost::ProjectedArea, 0));
  EXPECT_EQ(order(TreeCost::Mixed, 1), order(TreeCost::SurfaceArea, 0));
  EXPECT_NE(order(TreeCost::Mixed, 0.3), order(TreeCost::SurfaceArea, 0));
}

/// Triangles one behind the other for rays along z, nearly alike.
scene::Scene stack(int triangles, std::uint64_t seed) {
  test::AreaRandom random(seed);
  scene::Scene scene;
  for (int i = 0; i < triangles; ++i) {
    const float z = 10.0f * static_cast<float>(i) / static_cast<float>(triangles), s = random.between(0.7f, 1);
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const Vec3& v : {Vec3{-s, -s, z}, Vec3{s, -s, z + 0.01f}, Vec3{0, s, z}}) scene.mesh.vertices.push_back(v);
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.lower = {-1, -1, 0};
  scene.upper = {1, 1, 10.01f};
  return scene;
}

TEST(LocalTree, by_a_mixed_cost_leans_much_less_than_by_projected_areas_where_these_overlap) {
  SCOPED_TRACE(oracle::seed_note());
  accel::BuildOptions options;
  options.bins = 40;
  options.max_leaf_triangles = 2;
  int level = 0, projected = 0, mixed = 0;
  for (std::uint64_t i = 0; i < 12; ++i) {
    const scene::Scene scene = stack(1000, oracle::test_seed() + i);
    const auto depth = [&](TreeCost cost) {
      return influence::build_for(scene.mesh, along_z(scene), {cost, TreeAxes::All}, options).depth;
    };
    level += depth(TreeCost::SurfaceArea);
    projected += depth(TreeCost::ProjectedArea);
    mixed += depth(TreeCost::Mixed);
  }
  EXPECT_GT(projected, 1.5 * level) << "a cut before the largest triangle is always PAH's best";
  EXPECT_LT(mixed - level, 0.5 * (projected - level));
}

TEST(LocalTree, without_an_area_to_follow_is_the_plain_tree) {
  const scene::Scene scene = scene::load("gen:foliage?twigs=40");
  const Bvh4 plain = accel::build(scene.mesh, {});
  EXPECT_EQ(ids(influence::build_for(scene.mesh, {}, {TreeCost::SurfaceArea, TreeAxes::All}, {})), ids(plain));
}

}  // namespace
}  // namespace ctu
