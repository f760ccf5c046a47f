// rtl/triangle_test.sv against the model's triangle_test within a unit at work: every handshake, outcome and account in
// every cycle.
#include <vector>

#include "VMutantBestAfterInterval.h"
#include "VMutantTriangleLastEarly.h"
#include "VTriangleTest1.h"
#include "VTriangleTest13.h"
#include "VTriangleTest45.h"
#include "model/numeric/round.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using numeric::bits;

constexpr int kSlotBits = 5;

/// What the twin reads of its contexts: rays, the best t from before the cycle, and the bytes of leaves.
class ContextReads {
 public:
  ContextReads(pipeline::TappedUnit& unit, const accel::Image& image)
      : unit_(unit), image_(image), leaf_(1u << kSlotBits), best_t_(1u << kSlotBits) {}

  void arrived(const pipeline::LeafToken& leaf) { leaf_[leaf.slot] = leaf.ref; }

  template <class Model>
  void answer(Model& twin) {
    twin.best_t_i = bits(best_t_[twin.best_slot_o]);
    if (twin.ray_slot_o >= contexts()) return;
    const intersect::PreparedRay& ray = unit_.state().source.registers(twin.ray_slot_o).ray;
    BitWriter origin(&twin.ray_origin_i[0]);
    for (int axis = 0; axis < 3; ++axis) origin.put(ray.ray.origin[axis]);
    twin.ray_direction_z_i = bits(ray.ray.direction[ray.kz]);
    twin.ray_kx_i = ray.kx;
    twin.ray_ky_i = ray.ky;
    twin.ray_kz_i = ray.kz;
    twin.ray_sx_i = bits(ray.sx);
    twin.ray_sy_i = bits(ray.sy);
    twin.ray_tmin_i = bits(ray.ray.tmin);
    answer_triangle(twin);
  }
  /// Register files hold from the next cycle on what was written in this one.
  void end_cycle() {
    for (int slot = 0; slot < contexts(); ++slot)
      best_t_[static_cast<std::size_t>(slot)] =
          unit_.state().source.registers(static_cast<pipeline::Slot>(slot)).best.t;
  }

 private:
  int contexts() { return unit_.state().contexts.count(); }
  template <class Model>
  void answer_triangle(Model& twin) {
    const accel::ChildRef leaf = leaf_[twin.triangle_slot_o];
    if (!accel::is_leaf(leaf) || twin.triangle_index_o >= accel::leaf_count(leaf)) return;  // nothing enters
    const std::uint64_t at = image_.triangle_address(accel::leaf_first(leaf) + twin.triangle_index_o);
    BitWriter triangle(&twin.triangle_i[0]);
    for (std::uint64_t byte = 0; byte < accel::kTriangleBytes; ++byte) triangle.put(image_.bytes[at + byte], 8);
  }

  pipeline::TappedUnit& unit_;
  const accel::Image& image_;
  std::vector<accel::ChildRef> leaf_;
  std::vector<float> best_t_;
};

template <class Words>
void compare_outcome(Difference& difference, const Words& data, const pipeline::ComputedTest& model) {
  BitReader twin(&data[0]);
  difference.same("primitive", twin.take(32), model.candidate.primitive)
      .same("v", twin.take(32), bits(model.candidate.v))
      .same("u", twin.take(32), bits(model.candidate.u))
      .same("t", twin.take(32), bits(model.candidate.t))
      .same("hit", twin.take(1), model.hit)
      .same("last", twin.take(1), model.last)
      .same("index", twin.take(4), model.index)
      .same("slot", twin.take(kSlotBits), model.slot);
}

struct Compared {
  std::string difference;
  std::uint64_t leaves = 0, triangles = 0, hits = 0, waits = 0;
};

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  twin.interval_i = static_cast<unsigned char>(config.triangle_test.interval);
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().triangle_test;
  ContextReads reads(run.unit(), world.image());
  Difference difference;
  Compared compared;
  compared.difference = run.first_difference([&] {
    const pipeline::LeafToken& leaf = stage.leaf.token;
    if (stage.leaf.valid) reads.arrived(leaf);
    twin.leaf_valid_i = stage.leaf.valid;
    twin.leaf_data_i = static_cast<std::uint64_t>(leaf.slot) << 32 | leaf.ref;
    twin.tested_ready_i = stage.tested.ready;
    twin.eval();
    reads.answer(twin);
    twin.eval();
    difference.same("leaf pop", twin.leaf_pop_o, stage.leaf.popped)
        .same("tested push", twin.tested_push_o, stage.tested.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.tested.pushed) compare_outcome(difference, twin.tested_data_o, stage.tested.token);
    compared.leaves += stage.leaf.popped;
    compared.triangles += stage.tested.pushed;
    compared.hits += stage.tested.pushed && stage.tested.token.hit;
    compared.waits += stage.account.current() == pipeline::Activity::Interval;
    clock(twin);
    reads.end_cycle();
    return difference.take();
  });
  return compared;
}

const test::World& scene() {
  static const test::World world("gen:tilted-quads?quads=200", cull::Design::None, 120);
  return world;
}

/// Leaves of 15 triangles, every one of them hit.
const test::World& long_leaves() {
  static const test::World world(test::stacked_leaves(3, accel::kMaxLeafTriangles), cull::Design::None,
                                 std::vector<intersect::Ray>(40, test::ray_through_leaves()));
  return world;
}

pipeline::UnitConfig config_of(const test::World& world, int latency, int interval) {
  pipeline::UnitConfig config = world.config();
  config.ray_setup.interval = 1;
  config.triangle_test.latency = latency;
  config.triangle_test.interval = interval;
  return config;
}

template <class Model>
void expect_equal(int latency) {
  std::uint64_t hits = 0, waits = 0;
  for (const test::World* world : {&scene(), &long_leaves()}) {
    for (const int interval : {1, 2, 7}) {
      for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
        const Compared compared = compare<Model>(*world, config_of(*world, latency, interval), stall_seed);
        EXPECT_EQ(compared.difference, "")
            << "latency " << latency << ", interval " << interval << ", stall seed " << stall_seed;
        EXPECT_EQ(compared.leaves, world->counts().leaf_visits);
        EXPECT_EQ(compared.triangles, world->counts().triangle_tests);
        hits += compared.hits;
        waits += compared.waits;
      }
    }
  }
  EXPECT_GT(hits, 1000u);
  EXPECT_GT(waits, 1000u);
}

TEST(TriangleTest, equals_the_model_in_every_cycle_at_latency_45) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VTriangleTest45>(45);
}
TEST(TriangleTest, equals_the_model_in_every_cycle_at_latency_13) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VTriangleTest13>(13);
}
TEST(TriangleTest, equals_the_model_in_every_cycle_at_latency_1) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VTriangleTest1>(1);
}
TEST(TriangleTest, equals_the_model_at_the_longest_interval) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_EQ(compare<VTriangleTest1>(long_leaves(), config_of(long_leaves(), 1, 100), 0).difference, "");
}

TEST(TriangleTestMutants, the_best_t_of_a_later_cycle_than_the_first_at_the_entrance_is_caught) {
  SCOPED_TRACE(oracle::seed_note());
  const std::string difference =
      compare<VMutantBestAfterInterval>(long_leaves(), config_of(long_leaves(), 1, 7), 0).difference;
  EXPECT_NE(difference, "");
}
TEST(TriangleTestMutants, a_leaf_that_ends_one_triangle_early_is_caught) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_NE(compare<VMutantTriangleLastEarly>(scene(), config_of(scene(), 1, 1), 0).difference, "");
}

}  // namespace
}  // namespace ctu::rtl
