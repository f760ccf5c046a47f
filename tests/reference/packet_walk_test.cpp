// Packets that walk the top of the tree for their rays: no ray finds anything else than alone, and no triangle that one
// of them meets lies outside the packet's entries.
#include "model/reference/packet_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/cull/object_masks.h"
#include "model/cull/packet/packet_slabs.h"
#include "model/reference/packet_forming.h"
#include "model/scene/load.h"
#include "sim/check/hard_case.h"
#include "sim/hit_judge.h"
#include "tests/oracle/ray_oracle.h"
#include "tests/oracle/seed.h"
#include "tests/reference/rays.h"

namespace {

using namespace ctu;
using intersect::Hit;
using intersect::Ray;
using reference::PacketPlan;
using reference::PacketWalk;

std::uint64_t random_bits(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state >> 24;
}

/// Of every class: zeros, small whole numbers, and any finite bit pattern.
float random_number(std::uint64_t& state) {
  const std::uint64_t kind = random_bits(state) % 4;
  if (kind == 0) return 0.0f * (random_bits(state) % 2 == 0 ? 1.0f : -1.0f);
  if (kind <= 2) return (static_cast<float>(random_bits(state) % 17) - 8) * (kind == 1 ? 1.0f : 0.1f);
  const float any = std::bit_cast<float>(static_cast<std::uint32_t>(random_bits(state)));
  return std::isfinite(any) ? any : 1.5f;
}

std::string bits_of(const Ray& r) {
  return fmt::format("origin {:a} {:a} {:a} direction {:a} {:a} {:a} t [{:a}, {:a}]", r.origin.x, r.origin.y,
                     r.origin.z, r.direction.x, r.direction.y, r.direction.z, r.tmin, r.tmax);
}

TEST(PacketSlabs, a_packet_meets_what_the_slab_test_of_one_of_its_rays_meets_not_later_and_surely_what_all_meet) {
  SCOPED_TRACE(oracle::seed_note());
  std::uint64_t state = oracle::test_seed(), met = 0, missed = 0, sure = 0;
  for (int round = 0; round < 40000; ++round) {
    std::vector<intersect::PreparedRay> rays;
    cull::packet::PacketSlabs packet;
    // In every other round all rays go much the same way, or the packet would mostly know nothing.
    Ray like;
    for (int axis = 0; axis < 3; ++axis) {
      like.origin[axis] = random_number(state);
      like.direction[axis] = random_number(state);
    }
    while (rays.size() < 1 + random_bits(state) % 5) {
      Ray ray = like;
      for (int axis = 0; axis < 3; ++axis) {
        if (round % 2 == 0 || random_bits(state) % 4 == 0) ray.origin[axis] = random_number(state);
        if (round % 2 == 0) ray.direction[axis] = random_number(state);
        if (random_bits(state) % 3 == 0) ray.direction[axis] *= 1.25f;
      }
      ray.tmin = round % 3 == 0 ? random_number(state) : 0;
      ray.tmax = round % 5 == 0 ? random_number(state) : std::numeric_limits<float>::infinity();
      const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
      if (!prepared.valid) {
        for (int axis = 0; axis < 3; ++axis) like.direction[axis] = random_number(state);
        continue;
      }
      rays.push_back(prepared);
      packet.add(prepared);
    }
    intersect::Box4 boxes;
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      for (int axis = 0; axis < 3; ++axis) {
        const float a = random_number(state), b = random_bits(state) % 4 == 0 ? a : random_number(state);
        const bool empty = lane == 3 && round % 7 == 0;
        boxes.lo[axis][lane] = empty ? std::numeric_limits<float>::infinity() : std::min(a, b);
        boxes.hi[axis][lane] = empty ? -std::numeric_limits<float>::infinity() : std::max(a, b);
      }
    const cull::packet::PacketTimes found = packet.test(boxes);
    ASSERT_EQ(found.sure & ~found.hit, 0);
    sure += static_cast<unsigned>(std::popcount(found.sure));
    missed += 4 - static_cast<unsigned>(std::popcount(found.hit));
    if (round % 7 == 0) {
      ASSERT_EQ(found.hit >> 3, 0) << "an empty lane is met";
    }
    for (const intersect::PreparedRay& ray : rays) {
      intersect::SlabTimes times;
      intersect::slab_test_outer(ray, boxes, ray.ray.tmax, times);
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        const bool hit = (times.hit >> lane & 1) != 0;
        ASSERT_TRUE(hit || (found.sure >> lane & 1) == 0)
            << "round " << round << ", lane " << lane << ", " << bits_of(ray.ray);
        if (!hit) continue;
        ++met;
        ASSERT_NE(found.hit >> lane & 1, 0) << "round " << round << ", lane " << lane << ", " << bits_of(ray.ray);
        ASSERT_LE(found.t0[lane], times.t0[lane]) << "round " << round << ", lane " << lane << ", " << bits_of(ray.ray);
      }
    }
  }
  EXPECT_GT(met, 10000u);
  EXPECT_GT(missed, 10000u);
  EXPECT_GT(sure, 1000u);
}

TEST(PacketSlabs, one_ray_by_itself_is_bounded_as_the_slab_test_bounds_it) {
  const scene::Scene scene = scene::load("gen:hair-ball?strands=60");
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  for (const Ray& ray : test::random_rays(scene, 200, oracle::test_seed())) {
    const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
    cull::packet::PacketSlabs packet;
    packet.add(prepared);
    for (const accel::Node4& node : bvh.nodes) {
      intersect::SlabTimes times;
      intersect::slab_test_outer(prepared, node.boxes, ray.tmax, times);
      const cull::packet::PacketTimes found = packet.test(node.boxes);
      ASSERT_EQ(found.hit, times.hit) << bits_of(ray);
      ASSERT_EQ(found.sure & ~times.hit, 0) << bits_of(ray);
      for (int lane = 0; lane < intersect::kLanes; ++lane)
        if ((times.hit >> lane & 1) != 0) {
          ASSERT_EQ(found.t0[lane], times.t0[lane]) << bits_of(ray);
        }
    }
  }
}

/// A tree with what lies above each primitive.
struct World {
  explicit World(const scene::Mesh& mesh) : bvh(accel::build(mesh, {})), above(mesh.primitives()) { descend(0, {}); }

  accel::Bvh4 bvh;
  std::vector<std::vector<std::uint32_t>> above;

 private:
  void descend(std::uint32_t node, std::vector<std::uint32_t> path) {
    path.push_back(node);
    for (const accel::ChildRef child : bvh.nodes[node].child) {
      if (accel::is_inner(child)) descend(child, path);
      if (!accel::is_leaf(child)) continue;
      for (int i = 0; i < accel::leaf_count(child); ++i)
        above[bvh.triangles[accel::leaf_first(child) + static_cast<std::uint32_t>(i)].primitive] = path;
    }
  }
};

std::vector<Ray> ordered(const std::vector<Ray>& rays, const reference::FormingOptions& forming) {
  std::vector<Ray> out;
  for (const std::uint32_t i : reference::packet_order(rays, forming)) out.push_back(rays[i]);
  return out;
}

bool covers(const PacketWalk& walk, const World& world, std::uint64_t ray, std::uint32_t primitive) {
  const reference::PacketList& list = walk.list();
  const std::uint64_t packet = list.packet_of(ray);
  for (std::uint64_t i = list.first_entry[packet]; i < list.first_entry[packet + 1]; ++i)
    if (std::count(world.above[primitive].begin(), world.above[primitive].end(), list.entries[i]) != 0) return true;
  return false;
}

/// Several packets' sizes, numbers of entries, ways to form them and designs. Of hard cases a hit may be another one
/// where none is lost in exact arithmetic: a near miss, or one of several primitives that meet at one place.
void expect_same_in_packets(const scene::Mesh& mesh, const std::vector<Ray>& unordered, bool hard) {
  const sim::HitJudge judge(mesh);
  const World world(mesh);
  const cull::ObjectMasks masks = cull::build_object_masks(world.bvh, {}, 1);
  int turn = 0;
  for (const PacketPlan plan :
       {PacketPlan{4, 1}, PacketPlan{8, 16}, PacketPlan{16, 4}, PacketPlan{64, 2}, PacketPlan{7, 8}})
    for (const cull::Design design : {cull::Design::None, cull::Design::Comparators}) {
      const auto forming = static_cast<reference::Forming>(turn++ % 3);
      SCOPED_TRACE(fmt::format("packets of {}, {} entries, by {}, {}", plan.size, plan.most_entries, to_string(forming),
                               to_string(design)));
      const std::vector<Ray> rays = ordered(unordered, {.size = plan.size, .window = 128, .forming = forming});
      const cull::MaskTester tester(design, {}), none(cull::Design::None, {});
      const reference::Traversal traversal(world.bvh, &masks, tester), alone(world.bvh, nullptr, none);
      const PacketWalk walk(world.bvh, plan, rays,
                            reference::cut_packets(static_cast<std::uint32_t>(rays.size()), plan.size));
      reference::StepList steps;
      const std::vector<Hit> hits = walk.trace(traversal, steps);
      ASSERT_EQ(hits.size(), rays.size());
      ASSERT_EQ(steps.spared.size(), rays.size());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = alone.trace(rays[i]);
        const bool judged = hard && intersect::is_valid(rays[i]) && !same_bits(hits[i], expected);
        if (judged)
          ASSERT_NE(judge.judge(rays[i], expected, hits[i]), sim::Verdict::Lost)
              << "ray " << i << ": " << bits_of(rays[i]);
        else if (rays[i].kind == intersect::RayKind::ClosestHit || expected.primitive == intersect::kNoPrimitive)
          ASSERT_TRUE(same_bits(hits[i], expected)) << "ray " << i << ": " << bits_of(rays[i]);
        else
          ASSERT_NE(hits[i].primitive, intersect::kNoPrimitive) << "ray " << i << ": " << bits_of(rays[i]);
        if (hits[i].primitive == intersect::kNoPrimitive) continue;
        ASSERT_TRUE(covers(walk, world, i, hits[i].primitive)) << "ray " << i << ": " << bits_of(rays[i]);
      }
    }
}

TEST(PacketWalk, rays_find_from_entries_what_they_find_alone_in_generated_scenes) {
  SCOPED_TRACE(oracle::seed_note());
  for (const char* name :
       {"gen:hair-ball?strands=300", "gen:tilted-quads?quads=500", "gen:foliage?twigs=40", "gen:tetra?depth=4"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = scene::load(name);
    const accel::Bvh4 bvh = accel::build(scene.mesh, {});
    const reference::FastTracer tracer(bvh);
    std::vector<Ray> rays = test::primary_rays(scene, 32, 32);
    const std::vector<Ray> bounces = test::diffuse_rays(scene, tracer, rays, oracle::test_seed());
    for (const auto& more : {bounces, test::random_rays(scene, 300, oracle::test_seed()),
                             test::aimed_rays(scene, 300, oracle::test_seed())})
      rays.insert(rays.end(), more.begin(), more.end());
    for (std::size_t i = 0; i < rays.size(); i += 5) rays[i].kind = intersect::RayKind::AnyHit;
    for (std::size_t i = 3; i < rays.size(); i += 11) rays[i].tmax = 1;
    rays[7].direction = {0, 0, 0};  // not valid
    expect_same_in_packets(scene.mesh, rays, false);
  }
}

TEST(PacketWalk, rays_lose_nothing_from_entries_in_hard_cases) {
  SCOPED_TRACE(oracle::seed_note());
  const auto generators = sim::check::generators();
  for (std::uint32_t generator = 0; generator < generators.size(); ++generator) {
    if (generators[generator].name == "duplicates") continue;  // thousands of triangles
    SCOPED_TRACE(std::string(generators[generator].name));
    const sim::check::HardCase hard = sim::check::make_case(oracle::test_seed(), generator, 0);
    expect_same_in_packets(hard.mesh, hard.rays, true);
  }
}

TEST(PacketWalk, no_triangle_that_a_ray_meets_exactly_lies_outside_its_packets_entries) {
  SCOPED_TRACE(oracle::seed_note());
  const auto generators = sim::check::generators();
  std::uint64_t met = 0;
  for (std::uint32_t generator = 0; generator < generators.size(); ++generator) {
    if (generators[generator].name == "duplicates") continue;
    SCOPED_TRACE(std::string(generators[generator].name));
    const sim::check::HardCase hard = sim::check::make_case(oracle::test_seed(), generator, 1);
    const World world(hard.mesh);
    const PacketPlan plan{8, 4};
    const std::vector<Ray> rays =
        ordered(hard.rays, {.size = 8, .window = 64, .forming = reference::Forming::Direction});
    const PacketWalk walk(world.bvh, plan, rays, reference::cut_packets(static_cast<std::uint32_t>(rays.size()), 8));
    for (std::size_t i = 0; i < std::min<std::size_t>(rays.size(), 120); ++i) {
      if (!intersect::is_valid(rays[i])) continue;
      oracle::RayOracle oracle(rays[i]);
      for (std::uint32_t t = 0; t < hard.mesh.triangles.size() && t < 200; ++t) {
        const auto& [a, b, c] = hard.mesh.triangles[t];
        if (!oracle.meets_triangle(hard.mesh.vertices[a], hard.mesh.vertices[b], hard.mesh.vertices[c])) continue;
        ++met;
        ASSERT_TRUE(covers(walk, world, i, t)) << "triangle " << t << ", ray " << i << ": " << bits_of(rays[i]);
      }
    }
  }
  EXPECT_GT(met, 100u);
}

TEST(PacketWalk, with_one_entry_a_ray_visits_what_it_visits_alone_but_for_what_lies_above_it) {
  const scene::Scene scene = scene::load("gen:hair-ball?strands=300");
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  const std::vector<Ray> rays = test::primary_rays(scene, 64, 64);
  const cull::MaskTester none(cull::Design::None, {});
  const reference::Traversal traversal(bvh, nullptr, none);
  const PacketWalk walk(bvh, {8, 1}, rays, reference::cut_packets(static_cast<std::uint32_t>(rays.size()), 8));
  reference::StepList steps, alone;
  walk.trace(traversal, steps);
  for (const Ray& ray : rays) traversal.trace(ray, &alone);
  std::uint64_t spared = 0;
  for (std::uint64_t i = 0; i < rays.size(); ++i) {
    const reference::Counts with = count_steps(steps, i, i + 1), without = count_steps(alone, i, i + 1);
    ASSERT_EQ(with.triangle_tests, without.triangle_tests) << i;
    // Where the ray misses the entry itself, it has asked for that node in vain.
    const std::uint64_t rest = without.node_visits - steps.spared[i];
    ASSERT_TRUE(with.node_visits == rest || (rest == 0 && with.node_visits == 1)) << i;
    spared += steps.spared[i];
  }
  EXPECT_GT(spared, rays.size() / 2);
}

TEST(PacketWalk, a_packet_keeps_within_its_entries_and_ends_above_leaves) {
  const scene::Scene scene = scene::load("gen:tilted-quads?quads=300");
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  const std::vector<Ray> rays = test::primary_rays(scene, 20, 20);
  std::set<std::uint64_t> counts;
  for (int most = 1; most <= reference::kMostEntries; ++most) {
    const PacketWalk walk(bvh, {4, most}, rays, reference::cut_packets(400, 4));
    for (std::uint64_t p = 0; p < walk.list().packets(); ++p) {
      const std::uint64_t entries = walk.list().first_entry[p + 1] - walk.list().first_entry[p];
      ASSERT_LE(entries, static_cast<std::uint64_t>(most));
      counts.insert(entries);
    }
    for (const accel::ChildRef entry : walk.list().entries) ASSERT_TRUE(accel::is_inner(entry));
  }
  EXPECT_GT(counts.size(), 3u);
}

TEST(PacketWalk, a_ray_that_finds_nothing_asks_for_no_more_nodes_than_alone) {
  SCOPED_TRACE(oracle::seed_note());
  std::uint64_t with = 0, without = 0;
  for (const char* name : {"gen:hair-ball?strands=300", "gen:foliage?twigs=40"}) {
    const scene::Scene scene = scene::load(name);
    const accel::Bvh4 bvh = accel::build(scene.mesh, {});
    std::vector<Ray> rays = test::primary_rays(scene, 48, 48);
    const std::vector<Ray> more = test::random_rays(scene, 500, oracle::test_seed());
    rays.insert(rays.end(), more.begin(), more.end());
    const cull::MaskTester none(cull::Design::None, {});
    const reference::Traversal traversal(bvh, nullptr, none);
    reference::StepList alone;
    for (const Ray& ray : rays) traversal.trace(ray, &alone);
    for (const PacketPlan plan : {PacketPlan{4, 16}, {16, 8}, {64, 16}}) {
      const PacketWalk walk(bvh, plan, rays,
                            reference::cut_packets(static_cast<std::uint32_t>(rays.size()), plan.size));
      reference::StepList steps;
      const std::vector<Hit> hits = walk.trace(traversal, steps);
      for (std::uint64_t i = 0; i < rays.size(); ++i) {
        if (hits[i].primitive != intersect::kNoPrimitive) continue;  // what a hit drops depends on the order
        const std::uint64_t of_ray = count_steps(steps, i, i + 1).node_visits;
        const std::uint64_t of_alone = count_steps(alone, i, i + 1).node_visits;
        ASSERT_LE(of_ray, of_alone) << name << ", packets of " << plan.size << ", " << bits_of(rays[i]);
        with += of_ray, without += of_alone;
      }
    }
  }
  EXPECT_LT(with, without * 9 / 10);
}

TEST(PacketWalk, entries_are_kept_nearest_first_and_equal_ones_as_they_come) {
  reference::EntryList list;
  for (const reference::Entry entry : {reference::Entry{1, 5}, {2, 3}, {3, 5}, {4, -1}, {5, 3}}) list.add(entry);
  std::vector<accel::ChildRef> refs;
  for (int i = 0; i < list.count(); ++i) refs.push_back(list[i].ref);
  EXPECT_EQ(refs, (std::vector<accel::ChildRef>{4, 2, 5, 1, 3}));
}

TEST(PacketWalk, a_packet_without_a_valid_ray_visits_nothing) {
  const accel::Bvh4 bvh = accel::build(scene::load("gen:tetra?depth=2").mesh, {});
  std::vector<Ray> rays(6);
  rays[5].direction = {0, 0, 1};
  rays[5].tmax = 1;
  const PacketWalk walk(bvh, {5, 4}, rays, reference::cut_packets(6, 5));
  ASSERT_EQ(walk.list().packets(), 2u);
  EXPECT_EQ(walk.list().first_visit[1], 0u);
  EXPECT_GT(walk.list().first_visit[2], 0u);
}

TEST(PacketOrder, keeps_every_ray_once_and_those_that_are_not_valid_behind_their_window) {
  const scene::Scene scene = scene::load("gen:tetra?depth=3");
  std::vector<Ray> rays = test::random_rays(scene, 300, oracle::test_seed());
  for (std::size_t i = 0; i < rays.size(); i += 9) rays[i].direction = {};
  for (const auto forming : {reference::Forming::Order, reference::Forming::Direction, reference::Forming::Origin}) {
    std::vector<std::uint32_t> order = reference::packet_order(rays, {.size = 8, .window = 100, .forming = forming});
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      ASSERT_EQ(order[i] / 100, i / 100);
      if (i / 100 == (i + 1) / 100) {
        ASSERT_LE(intersect::is_valid(rays[order[i + 1]]), intersect::is_valid(rays[order[i]]));
      }
    }
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
    ASSERT_EQ(order.size(), rays.size());
  }
}

TEST(PacketPlanCheck, sizes_and_entries_out_of_range_are_refused_by_name) {
  for (const auto& [plan, named] : {std::pair{PacketPlan{3, 4}, "packets"},
                                    {PacketPlan{65, 4}, "packets"},
                                    {PacketPlan{8, 0}, "packet entries"},
                                    {PacketPlan{8, 17}, "packet entries"}})
    try {
      reference::check(plan);
      FAIL() << plan.size << " rays, " << plan.most_entries << " entries";
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), named);
    }
  EXPECT_NO_THROW(reference::check(PacketPlan{}));
  EXPECT_NO_THROW(reference::check(PacketPlan{64, 16}));
}

}  // namespace
