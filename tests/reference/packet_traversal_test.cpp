// Rays in packets find what they find alone, whatever the method, the packets' size and how they were formed.
#include "model/reference/packet_traversal.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "sim/check/hard_case.h"
#include "tests/oracle/ray_oracle.h"
#include "tests/oracle/seed.h"
#include "tests/reference/rays.h"
#include "tests/support/real_scenes.h"

namespace {

using namespace ctu;
using cull::packet::Method;
using intersect::Hit;
using intersect::Ray;
using reference::Forming;
using reference::FormingOptions;
using reference::PacketCounts;
using reference::PacketOptions;

std::vector<Hit> alone(const accel::Bvh4& bvh, const std::vector<Ray>& rays, reference::Counts& counts) {
  const cull::MaskTester none(cull::Design::None, {});
  const reference::Traversal traversal(bvh, nullptr, none);
  reference::StepList steps;
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(traversal.trace(ray, &steps));
  counts = count_steps(steps, 0, steps.rays());
  return hits;
}

std::vector<Hit> in_packets(const accel::Bvh4& bvh, const std::vector<Ray>& rays, const PacketOptions& options,
                            const FormingOptions& forming, PacketCounts& counts) {
  const cull::MaskTester none(cull::Design::None, {});
  std::vector<Hit> hits(rays.size());
  reference::PacketTraversal(bvh, nullptr, none, options).trace(rays, forming, hits, counts);
  return hits;
}

/// A ray's hit may only change where the triangle found alone is one that the exact ray misses.
void expect_same_hits(const scene::Mesh& mesh, const std::vector<Ray>& rays, const std::vector<Hit>& expected,
                      const std::vector<Hit>& hits) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (same_bits(expected[i], hits[i])) continue;
    ASSERT_NE(expected[i].primitive, intersect::kNoPrimitive) << "ray " << i << " has found what it misses alone";
    const auto& [a, b, c] = mesh.triangles[expected[i].primitive];
    oracle::RayOracle oracle(rays[i]);
    ASSERT_FALSE(oracle.meets_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]))
        << "ray " << i << " of " << rays.size() << " has lost primitive " << expected[i].primitive << " at "
        << expected[i].t << " and found " << hits[i].primitive << " at " << hits[i].t;
  }
}

/// All methods and several kinds of packets.
void expect_same_in_packets(const scene::Mesh& mesh, const accel::Bvh4& bvh, const std::vector<Ray>& rays) {
  reference::Counts single;
  const std::vector<Hit> expected = alone(bvh, rays, single);
  int turn = 0;
  for (const Method method : cull::packet::kMethods) {
    const FormingOptions forming{.size = 4 << (turn % 5), .window = 128, .forming = static_cast<Forming>(turn % 3)};
    const PacketOptions options{.method = method, .least_rays = 2 + turn % 3, .splits = turn % 2 == 0};
    SCOPED_TRACE(std::string(to_string(method)) + " in packets of " + std::to_string(forming.size));
    PacketCounts counts;
    expect_same_hits(mesh, rays, expected, in_packets(bvh, rays, options, forming, counts));
    ++turn;
  }
}

struct World {
  scene::Scene scene;
  accel::Bvh4 bvh;
  explicit World(const std::string& name) : scene(scene::load(name)), bvh(accel::build(scene.mesh, {})) {}

  std::vector<Ray> camera_and_bounces(int size) const {
    const reference::FastTracer tracer(bvh);
    std::vector<Ray> rays = test::primary_rays(scene, size, size);
    const std::vector<Ray> bounces = test::diffuse_rays(scene, tracer, rays, oracle::test_seed());
    rays.insert(rays.end(), bounces.begin(), bounces.end());
    return rays;
  }
};

TEST(PacketTraversal, rays_find_in_packets_what_they_find_alone_in_generated_scenes) {
  SCOPED_TRACE(oracle::seed_note());
  for (const char* name :
       {"gen:hair-ball?strands=300", "gen:tilted-quads?quads=500", "gen:foliage?twigs=40", "gen:tetra?depth=4"}) {
    SCOPED_TRACE(name);
    const World world(name);
    std::vector<Ray> rays = world.camera_and_bounces(48);
    for (const auto& more : {test::random_rays(world.scene, 500, oracle::test_seed()),
                             test::aimed_rays(world.scene, 500, oracle::test_seed())})
      rays.insert(rays.end(), more.begin(), more.end());
    for (std::size_t i = 0; i < rays.size(); i += 3) rays[i].kind = intersect::RayKind::AnyHit;
    rays[7].direction = {0, 0, 0};  // not valid: in no packet
    expect_same_in_packets(world.scene.mesh, world.bvh, rays);
  }
}

TEST(PacketTraversal, rays_find_in_packets_what_they_find_alone_in_hard_cases) {
  SCOPED_TRACE(oracle::seed_note());
  const auto generators = sim::check::generators();
  for (std::uint32_t generator = 0; generator < generators.size(); ++generator) {
    if (generators[generator].name == "duplicates") continue;  // thousands of triangles
    SCOPED_TRACE(std::string(generators[generator].name));
    const sim::check::HardCase hard = sim::check::make_case(oracle::test_seed(), generator, 0);
    expect_same_in_packets(hard.mesh, accel::build(hard.mesh, {}), hard.rays);
  }
}

TEST(PacketTraversal, rays_find_in_packets_what_they_find_alone_in_shared_scenes) {
  const std::filesystem::path folder = test::unpacked_scenes();
  if (folder.empty() || !std::filesystem::exists(folder / "bunny/bunny.ply.zst")) GTEST_SKIP() << "no shared scenes";
  const World world((folder / "bunny/bunny.ply.zst").string());
  expect_same_in_packets(world.scene.mesh, world.bvh, world.camera_and_bounces(64));
}

TEST(PacketTraversal, a_ray_asks_for_each_test_once_itself_or_through_its_packet) {
  const World world("gen:tilted-quads?quads=60&size=0.8");
  const std::vector<Ray> rays = world.camera_and_bounces(64);
  reference::Counts single;
  alone(world.bvh, rays, single);
  for (const Method method : cull::packet::kMethods) {
    SCOPED_TRACE(std::string(to_string(method)));
    PacketCounts counts;
    in_packets(world.bvh, rays, {.method = method}, {.size = 16, .window = 64, .forming = Forming::Direction}, counts);
    EXPECT_EQ(counts.rays, rays.size());
    EXPECT_EQ(counts.node_tests + counts.saved_node_tests, single.node_visits);
    EXPECT_EQ(counts.primitive_tests + counts.saved_primitive_tests, single.triangle_tests);
    EXPECT_GT(counts.saved_primitive_tests, 0u);
    EXPECT_GT(counts.saved_box_tests, counts.saved_node_tests);
    EXPECT_LE(counts.alone_node_tests, counts.node_tests);
    EXPECT_LE(counts.box_misses, counts.box_questions);
  }
}

TEST(PacketTraversal, packets_that_do_not_cull_ask_nothing_and_save_nothing) {
  const World world("gen:tilted-quads?quads=200");
  const std::vector<Ray> rays = world.camera_and_bounces(32);
  reference::Counts single;
  alone(world.bvh, rays, single);
  PacketCounts counts;
  in_packets(world.bvh, rays, {.culls = false}, {}, counts);
  EXPECT_EQ(counts.questions(), 0u);
  EXPECT_EQ(counts.node_tests, single.node_visits);
  EXPECT_EQ(counts.primitive_tests, single.triangle_tests);
}

TEST(PacketTraversal, a_packet_splits_where_a_subtree_lies_inside_of_it) {
  const World world("gen:hair-ball?strands=300");
  const std::vector<Ray> rays = test::primary_rays(world.scene, 8, 8);  // the whole picture is one packet
  const FormingOptions forming{.size = 64, .window = 64};
  PacketCounts split, whole;
  in_packets(world.bvh, rays, {.splits = true}, forming, split);
  in_packets(world.bvh, rays, {.splits = false}, forming, whole);
  EXPECT_GT(split.splits, 0u);
  EXPECT_EQ(whole.splits, 0u);
}

TEST(PacketForming, every_valid_ray_is_in_one_packet_of_its_window) {
  const World world("gen:tetra?depth=3");
  std::vector<Ray> rays = test::random_rays(world.scene, 1000, oracle::test_seed());
  rays[5].tmin = 1, rays[5].tmax = 0;
  for (const Forming forming : {Forming::Order, Forming::Direction, Forming::Origin}) {
    SCOPED_TRACE(std::string(to_string(forming)));
    std::set<std::uint32_t> seen;
    for (const auto& packet : reference::form_packets(rays, {.size = 24, .window = 100, .forming = forming})) {
      EXPECT_LE(packet.size(), 24u);
      for (const std::uint32_t i : packet) {
        EXPECT_TRUE(seen.insert(i).second) << i;
        EXPECT_EQ(i / 100, packet.front() / 100);
      }
    }
    EXPECT_EQ(seen.size(), 999u);
    EXPECT_FALSE(seen.contains(5));
  }
}

TEST(PacketForming, sorting_by_direction_puts_rays_of_one_octant_together) {
  const World world("gen:tetra?depth=3");
  const std::vector<Ray> rays = test::random_rays(world.scene, 1024, oracle::test_seed());
  const auto mixed = [&](Forming forming) {
    int packets = 0;
    for (const auto& packet : reference::form_packets(rays, {.size = 8, .window = 1024, .forming = forming})) {
      std::set<int> octants;
      for (const std::uint32_t i : packet)
        octants.insert((rays[i].direction.x < 0) * 4 + (rays[i].direction.y < 0) * 2 + (rays[i].direction.z < 0));
      packets += octants.size() > 1;
    }
    return packets;
  };
  EXPECT_LE(mixed(Forming::Direction), 7);
  EXPECT_GT(mixed(Forming::Order), 100);
}

TEST(PacketForming, sizes_out_of_range_are_refused) {
  EXPECT_THROW(reference::form_packets({}, {.size = 3}), Error);
  EXPECT_THROW(reference::form_packets({}, {.size = 65, .window = 128}), Error);
  EXPECT_THROW(reference::form_packets({}, {.size = 32, .window = 16}), Error);
  EXPECT_TRUE(reference::form_packets({}, {}).empty());
}

}  // namespace
