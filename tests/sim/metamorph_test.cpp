// Whole scenes transformed: what must be the same is, no hit is lost, nothing leaks; and each check finds what is
// broken on purpose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "model/scene/load.h"
#include "sim/metamorph/aimed_rays.h"
#include "sim/metamorph/carried.h"
#include "sim/metamorph/closed_parts.h"
#include "sim/metamorph/leaks.h"
#include "sim/metamorph/scene_check.h"
#include "sim/metamorph/scene_rays.h"
#include "tests/oracle/seed.h"
#include "tests/support/closed_meshes.h"

namespace ctu::sim::metamorph {
namespace {

using cull::Design;
using Rays = traces::RayOptions::Rays;

CheckOptions small_options() {
  CheckOptions options;
  for (const Rays kind : {Rays::Primary, Rays::Diffuse, Rays::Shadow, Rays::Ao, Rays::Random}) {
    traces::RayOptions rays;
    rays.kind = kind;
    rays.width = 16;
    rays.height = 12;
    rays.seed = oracle::test_seed();
    options.rays.push_back(rays);
  }
  options.world.masks.entries = 64;
  options.world.masks.selection = cull::Selection::TopSummed;
  options.world.designs = {Design::Ideal,    Design::MaskLut, Design::Projection,
                           Design::BitTable, Design::Dedup,   Design::Comparators};
  options.world.threads = 2;
  options.kinds = {Kind::Identity, Kind::Power, Kind::Factor, Kind::Translation, Kind::Permutation, Kind::Mirror};
  options.seed = oracle::test_seed();
  options.most_aimed = 4000;
  return options;
}

void tell(const std::string& words) { ADD_FAILURE() << words; }

void expect_all_kept(const std::string& name) {
  SCOPED_TRACE(oracle::seed_note());
  const SceneReport report = check_scene(scene::load(name), small_options(), [](const std::string&) {});
  EXPECT_TRUE(report.passed());
  for (const std::string& defect : report.defects) ADD_FAILURE() << name << ": " << defect;
  ASSERT_EQ(report.rows.size(), 1u + 4 + 3 + 4 + 5 + 7 + 1);
  EXPECT_TRUE(report.left_out.empty());
  for (const CheckRow& row : report.rows) {
    const bool promised = row.kind == Kind::Power || row.kind == Kind::Permutation || row.kind == Kind::Mirror;
    EXPECT_EQ(row.same, promised ? Same::Yes : Same::NotPromised) << row.name;
    EXPECT_GT(row.rays, 0u) << row.name;
    EXPECT_LE(row.not_compared, row.rays / 10) << row.name;
  }
}

TEST(Metamorph, the_bunny_keeps_its_answers) { expect_all_kept("/usr/share/glmark2/models/bunny.obj"); }
TEST(Metamorph, hair_keeps_its_answers) { expect_all_kept("gen:hair-ball?strands=300"); }
TEST(Metamorph, tilted_quads_keep_their_answers) { expect_all_kept("gen:tilted-quads?quads=500"); }
TEST(Metamorph, axis_parallel_walls_keep_their_answers) { expect_all_kept("gen:tetra?depth=4"); }

/// A scene of one closed mesh with the camera that a loaded one would have.
scene::Scene scene_of(const test::ClosedMesh& closed) {
  scene::Scene scene;
  scene.name = "closed mesh";
  scene.mesh = closed.mesh;
  const auto s = static_cast<float>(closed.size);
  const Vec3& m = closed.middle;
  scene.lower = {m.x - s, m.y - s, m.z - s};
  scene.upper = {m.x + s, m.y + s, m.z + s};
  scene.camera.eye = {m.x + 3 * s, m.y + 2 * s, m.z + 4 * s};
  scene.camera.target = m;
  return scene;
}

void expect_watertight(const test::ClosedMesh& closed, int resolution) {
  SCOPED_TRACE(oracle::seed_note());
  CheckOptions options = small_options();
  options.kinds.clear();
  options.reversed = false;
  options.world.masks.resolution = options.world.masks.ray_resolution = resolution;
  options.world.designs = {Design::Ideal, Design::MaskLut, Design::Comparators};
  options.most_aimed = 0;
  const SceneReport report = check_scene(scene_of(closed), options, [](const std::string&) {});
  for (const std::string& defect : report.defects) ADD_FAILURE() << defect;
  EXPECT_EQ(report.edges.parts, 1u);
  EXPECT_EQ(report.edges.triangles, closed.mesh.triangles.size());
  EXPECT_EQ(report.edges.edges, closed.mesh.triangles.size() * 3 / 2);
  EXPECT_GT(report.edges.rays, 3 * report.edges.edges);
  EXPECT_EQ(report.edges.found.leaks, 0u);
  EXPECT_LT(report.edges.found.passed_by, report.edges.rays / 100);
}

TEST(Metamorph, nothing_leaks_through_the_edges_of_a_sphere) {
  expect_watertight(test::closed_sphere(4), 4);
  expect_watertight(test::closed_sphere(3), 6);
}
TEST(Metamorph, nothing_leaks_through_the_edges_of_a_lattice_cube) {
  expect_watertight(test::closed_cube(16), 4);
  expect_watertight(test::closed_cube(9), 6);
}
TEST(Metamorph, nothing_leaks_through_edges_far_from_the_origin) {
  expect_watertight(test::moved(test::closed_sphere(3)), 4);
  expect_watertight(test::moved(test::closed_cube(10)), 4);
}

TEST(ClosedParts, are_found_whatever_their_winding_and_however_their_corners_are_shared) {
  const scene::Mesh sphere = test::icosphere(2);
  scene::Mesh soup;  // every triangle has corners of its own, every third is wound the other way
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t vertex : sphere.triangles[t]) soup.vertices.push_back(sphere.vertices[vertex]);
    if (t % 3 == 0)
      soup.triangles.push_back({first, first + 2, first + 1});
    else
      soup.triangles.push_back({first, first + 1, first + 2});
  }
  const ClosedParts closed = closed_parts(soup);
  EXPECT_EQ(closed.parts, 1u);
  ASSERT_EQ(closed.triangles.size(), sphere.triangles.size());
  for (const auto& [a, b, c] : closed.triangles) {
    const auto at = [&](std::uint32_t v) { return traces::widen(soup.vertices[v]); };
    EXPECT_GT(traces::dot(traces::cross(at(b) - at(a), at(c) - at(a)), at(a)), 0) << "points inwards";
  }
}

TEST(ClosedParts, what_has_a_hole_or_no_inside_is_left_out) {
  scene::Mesh holed = test::icosphere(1);
  holed.triangles.pop_back();
  EXPECT_EQ(closed_parts(holed).parts, 0u);

  scene::Mesh plane;  // the projective plane: two triangles at every edge, but it has one side only
  plane.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                     {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
  EXPECT_EQ(closed_parts(plane).parts, 0u);

  scene::Mesh three = test::icosphere(1);  // a fin at one edge
  three.vertices.push_back({5, 5, 5});
  three.triangles.push_back(
      {three.triangles[0][0], three.triangles[0][1], static_cast<std::uint32_t>(three.vertices.size() - 1)});
  EXPECT_EQ(closed_parts(three).parts, 0u);
}

/// A sphere's tree and the rays aimed at its edges, to be broken.
struct Sphere {
  scene::Mesh mesh = test::icosphere(3);
  accel::Bvh4 bvh = accel::build(mesh, {});
  WorldOptions options{{}, {}, {Design::MaskLut, Design::Comparators}, 2};
  AimedRays aimed = aim_at_edges(mesh, closed_parts(mesh), oracle::test_seed(), 0);
};

TEST(Metamorph, a_box_too_small_by_a_thousandth_leaks_and_loses_hits) {
  Sphere sphere;
  for (accel::Node4& node : sphere.bvh.nodes)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      float& hi = node.boxes.hi[0][lane];
      if (accel::is_leaf(node.child[lane])) hi -= 1e-3f * (hi - node.boxes.lo[0][lane]);
    }
  const World world(sphere.bvh, sphere.options);
  std::size_t told = 0;
  EXPECT_GT(find_leaks(sphere.mesh, world, sphere.aimed.rays, 2, [&](const std::string&) { ++told; }).leaks, 0u);
  EXPECT_GT(told, 0u);

  std::vector<intersect::Ray> rays;
  for (const AimedRay& one : sphere.aimed.rays) rays.push_back(one.ray);
  const Asked asked = ask_all(world, rays, 2, Record::HitsAndSteps);
  EXPECT_GT(judge_hits(sphere.mesh, world, asked, [](const std::string&) {}).lost, 0u);
}

TEST(Metamorph, a_cell_missing_from_every_mask_leaks_with_culling_only) {
  Sphere sphere;
  cull::ObjectMasks masks = cull::build_object_masks(sphere.bvh, {}, 2);
  for (std::uint64_t& bits : masks.bits) bits &= bits - 1;
  const World world(sphere.bvh, std::move(masks), sphere.options);
  std::size_t without = 0, with = 0;
  find_leaks(sphere.mesh, world, sphere.aimed.rays, 2,
             [&](const std::string& words) { ++(words.starts_with("none") ? without : with); });
  EXPECT_EQ(without, 0u);
  EXPECT_GT(with, 0u);
}

TEST(Metamorph, an_emptied_mask_changes_event_sequences_and_one_unit_of_a_box_the_tree) {
  Sphere sphere;
  const World world(sphere.bvh, sphere.options);
  std::vector<intersect::Ray> rays;
  for (const AimedRay& one : sphere.aimed.rays) rays.push_back(one.ray);
  const std::vector<bool> all(rays.size(), true);
  const Asked asked = ask_all(world, rays, 2, Record::HitsAndSteps);

  cull::ObjectMasks masks = world.masks();
  masks.bits[0] = 0;
  const World fewer(sphere.bvh, std::move(masks), sphere.options);
  const Asked changed = ask_all(fewer, rays, 2, Record::HitsAndSteps);
  EXPECT_EQ(different_steps(asked.answers[0], changed.answers[0], Keys::Compared, all), 0u);
  EXPECT_GT(different_steps(asked.answers[1], changed.answers[1], Keys::Compared, all), 0u);
  EXPECT_EQ(different_steps(asked.answers[1], changed.answers[1], Keys::Compared, std::vector<bool>(rays.size())), 0u);

  accel::Bvh4 moved = sphere.bvh;
  EXPECT_TRUE(same_tree(sphere.bvh, moved));
  moved.nodes.back().boxes.lo[2][0] = std::nextafter(moved.nodes.back().boxes.lo[2][0], -9.0f);
  EXPECT_FALSE(same_tree(sphere.bvh, moved));
}

TEST(Metamorph, rays_reversed_that_lose_their_triangle_are_told) {
  Sphere sphere;
  const World world(sphere.bvh, sphere.options);
  std::vector<intersect::Ray> back;
  std::vector<std::uint32_t> from;
  for (const AimedRay& one : sphere.aimed.rays) {
    const intersect::Hit hit = world.traversal(0).trace(one.ray);
    ASSERT_NE(hit.primitive, intersect::kNoPrimitive);
    back.push_back(reversed(one.ray, hit.t));
    from.push_back(hit.primitive);
  }
  Asked asked = ask_all(world, back, 2, Record::Hits);
  EXPECT_EQ(judge_way_back(sphere.mesh, world, asked, from, tell).lost, 0u);
  for (intersect::Hit& hit : asked.answers[1].hits) hit = {};
  std::size_t told = 0;
  const WayBack broken = judge_way_back(sphere.mesh, world, asked, from, [&](const std::string& words) {
    EXPECT_TRUE(words.starts_with("mask-lut LOST A HIT")) << words;
    ++told;
  });
  EXPECT_GT(broken.lost, back.size() / 2);
  EXPECT_EQ(broken.lost, told);
}

TEST(Transformation, symmetries_of_the_axes_are_48_and_keep_bits) {
  const std::vector<Transformation> all = axis_symmetries();
  ASSERT_EQ(all.size(), 48u);
  const Vec3 p{1.0f / 3, -2.0f / 7, 1e-30f};
  std::vector<std::vector<float>> images;
  for (const Transformation& t : all) {
    EXPECT_TRUE(t.is_exact()) << t.name;
    const Vec3 q = t.point(p);
    images.push_back({q.x, q.y, q.z});
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      EXPECT_EQ(q[axis], static_cast<float>(t.sign[a]) * p[t.from[a]]) << t.name;
    }
  }
  std::sort(images.begin(), images.end());
  EXPECT_EQ(std::adjacent_find(images.begin(), images.end()), images.end());
}

TEST(Transformation, powers_keep_clear_of_both_ends_of_the_range) {
  const auto names = [](double smallest, double largest) {
    std::vector<std::string> out;
    const TransformationList list = transformations({Kind::Power}, {smallest, largest, largest});
    for (const Transformation& t : list.transformations) {
      out.push_back(t.name);
      EXPECT_GE(smallest * t.factor, 0x1p-102);
      EXPECT_LT(largest * t.factor, 0x1p91);
    }
    const bool all = out == std::vector<std::string>{"x 2^-40", "x 2^-1", "x 2^7", "x 2^40"};
    EXPECT_EQ(list.left_out.empty(), all);
    return out;
  };
  EXPECT_EQ(names(1e-3, 10), (std::vector<std::string>{"x 2^-40", "x 2^-1", "x 2^7", "x 2^40"}));
  EXPECT_EQ(names(0x1p-70, 10), (std::vector<std::string>{"x 2^-32", "x 2^-1", "x 2^7", "x 2^40"}));
  EXPECT_EQ(names(1, 0x1p85), (std::vector<std::string>{"x 2^-40", "x 2^-1", "x 2^5"}));
  EXPECT_TRUE(names(0x1p-102, 0x1p90).empty());
}

TEST(Transformation, bits_are_not_promised_where_directions_tie_or_times_overflow) {
  const Magnitudes scene{1, 100, 100};
  const Transformation mirror = axis_symmetries()[1], power = transformations({Kind::Power}, scene).transformations[3];
  EXPECT_TRUE(keeps_bits(mirror, {{}, 0, {0.5f, 0.25f, 0}, 1}, scene));
  EXPECT_FALSE(keeps_bits(mirror, {{}, 0, {0.5f, -0.5f, 0}, 1}, scene));
  EXPECT_TRUE(keeps_bits(power, {{}, 0, {0.5f, -0.5f, 0}, 1}, scene));
  EXPECT_FALSE(keeps_bits(power, {{}, 0, {0.5f, 1e-30f, 0}, 1}, scene));
}

}  // namespace
}  // namespace ctu::sim::metamorph
