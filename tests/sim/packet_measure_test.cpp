// What `ctusim paper packets` measures: relations that hold on any scene.
#include <gtest/gtest.h>

#include "model/accel/build.h"
#include "model/scene/load.h"
#include "sim/paper/packet_measure.h"
#include "sim/paper/packet_tables.h"
#include "traces/ray_generator.h"

namespace ctu::sim::paper {
namespace {

struct World {
  explicit World(const std::string& name = "gen:tilted-quads?quads=200&size=0.4") : scene(scene::load(name)) {}

  scene::Scene scene;
  accel::Bvh4 bvh = accel::build(scene.mesh, {});

  RaySample sample(traces::RayOptions::Rays kind) const {
    const cull::MaskTester none(cull::Design::None, {});
    const reference::Traversal alone(bvh, nullptr, none);
    traces::RayOptions options;
    options.kind = kind;
    options.width = options.height = 48;
    options.tiled = true;
    return sample_rays(traces::RayGenerator(scene, options), alone, {}, 1);
  }
};

TEST(PacketMeasure, methods_find_a_part_of_what_all_rays_miss_and_nothing_else) {
  const World world;
  for (const auto kind : {traces::RayOptions::Rays::Primary, traces::RayOptions::Rays::Diffuse,
                          traces::RayOptions::Rays::Shadow, traces::RayOptions::Rays::Random}) {
    SCOPED_TRACE(std::string(traces::to_string(kind)));
    const PacketResult result = measure_packets(world.scene, world.bvh, world.sample(kind), {});
    EXPECT_EQ(result.wrong(), 0u);
    for (const PacketFindings* findings : {&result.boxes, &result.triangles}) {
      if (kind != traces::RayOptions::Rays::Random) {  // which hardly ever come to one leaf together
        EXPECT_GT(findings->questions, 0u);
      }
      EXPECT_LE(findings->all_miss, findings->questions);
      EXPECT_LE(findings->found_by_some, findings->all_miss);
      for (const std::uint64_t found : findings->found) EXPECT_LE(found, findings->found_by_some);
    }
    for (const PacketWork& work : result.work) {
      EXPECT_EQ(work.counts.node_tests + work.counts.saved_node_tests, result.single.node_visits);
      EXPECT_EQ(work.counts.primitive_tests + work.counts.saved_primitive_tests, result.single.triangle_tests);
    }
  }
}

TEST(PacketMeasure, spheres_are_asked_of_whole_packets_too) {
  const World world("gen:balls?depth=2");
  for (const auto kind : {traces::RayOptions::Rays::Primary, traces::RayOptions::Rays::Diffuse}) {
    SCOPED_TRACE(std::string(traces::to_string(kind)));
    const PacketResult result = measure_packets(world.scene, world.bvh, world.sample(kind), {});
    EXPECT_EQ(result.wrong(), 0u);
    EXPECT_GT(result.spheres.all_miss, 10u);
    EXPECT_LE(result.spheres.found_by_some, result.spheres.all_miss);
    if (kind == traces::RayOptions::Rays::Primary) {  // bounces from small balls go every way
      EXPECT_GT(result.spheres.found_by_some, result.spheres.all_miss / 4);
    }
    for (const PacketWork& work : result.work)
      EXPECT_EQ(work.counts.primitive_tests + work.counts.saved_primitive_tests, result.single.triangle_tests);
  }
}

TEST(PacketMeasure, camera_packets_find_most_and_affine_forms_cost_more_than_intervals) {
  const World world;
  const PacketResult result =
      measure_packets(world.scene, world.bvh, world.sample(traces::RayOptions::Rays::Primary), {});
  const auto of = [](cull::packet::Method method) { return static_cast<std::size_t>(method); };
  const std::size_t interval = of(cull::packet::Method::AxisInterval), affine = of(cull::packet::Method::Affine);
  EXPECT_GT(result.boxes.found[interval], result.boxes.all_miss * 2 / 3);
  EXPECT_GT(result.boxes.operations[affine].total(), result.boxes.operations[interval].total());
  EXPECT_GT(result.building[affine].total(), result.building[interval].total());
  EXPECT_GT(result.bloat.interval_length, static_cast<double>(result.bloat.packets)) << "directions have length 1";
}

TEST(PacketMeasure, nothing_depends_on_the_number_of_threads) {
  const World world;
  const RaySample sample = world.sample(traces::RayOptions::Rays::Diffuse);
  PacketMeasureOptions options;
  options.forming.window = 64;
  const PacketResult one = measure_packets(world.scene, world.bvh, sample, options);
  options.threads = 3;
  const PacketResult three = measure_packets(world.scene, world.bvh, sample, options);
  const std::vector<PacketRow> a{{"scene", "diffuse", one}}, b{{"scene", "diffuse", three}};
  EXPECT_EQ(packet_report(a, {}), packet_report(b, {}));
}

}  // namespace
}  // namespace ctu::sim::paper
