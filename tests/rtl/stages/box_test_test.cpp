// rtl/box_test.sv against the model's box_test within a unit at work: every handshake, hit and bound in every cycle;
// and against intersect::slab_test on hostile boxes, four lanes at a time.
#include <cstdlib>
#include <cstring>
#include <deque>
#include <random>

#include "VBoxTest.h"
#include "VBoxTestCompact.h"
#include "VBoxTestOuter1.h"
#include "VBoxTestOuter25.h"
#include "VBoxTestOuter6.h"
#include "VMutantBoxAxesSwapped.h"
#include "VMutantBoxSlotEarly.h"
#include "model/numeric/round.h"
#include "tests/intersect/hostile_boxes.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using intersect::kLanes;
using numeric::bits;

constexpr int kSlotBits = 5;

/// A Verilated box_test and what it is compared with.
template <class Model>
class Twin {
 public:
  explicit Twin(bool inner) : inner_(inner) { reset(model_); }

  Model& model() { return model_; }
  Difference& difference() { return difference_; }

  void set_ray(const intersect::PreparedRay& ray, float best_t) {
    const auto put = [](std::uint32_t* words, const Vec3& vector) {
      BitWriter(words).put(vector[0]).put(vector[1]).put(vector[2]);
    };
    put(&model_.ray_origin_i[0], ray.ray.origin);
    put(&model_.ray_rcp_down_i[0], ray.rcp_down);
    put(&model_.ray_rcp_up_i[0], ray.rcp_up);
    model_.ray_zero_axes_i = ray.zero_axes;
    model_.ray_negative_axes_i = ray.negative_axes;
    model_.ray_tmin_i = bits(ray.ray.tmin);
    model_.best_t_i = bits(best_t);
  }
  /// 96 bytes as they lie in memory.
  void set_boxes(const std::uint8_t* bytes) { std::memcpy(&model_.boxes_i[0], bytes, 96); }
  /// Those of a node of the world: of a compact one the frame, the planes behind the children, and who is there.
  void set_node(const test::World& world, std::uint32_t node) {
    const accel::Image& image = world.image();
    const std::uint8_t* const bytes = &image.bytes[image.node_address(node)];
    if (image.layout.box_bits == accel::kFullBoxBits) return set_boxes(bytes);
    std::memcpy(&model_.boxes_i[0], bytes, 16);
    std::memcpy(&model_.boxes_i[4], bytes + 32, 3 * image.layout.box_bits);
    model_.empty_i = 0;
    for (int lane = 0; lane < kLanes; ++lane)
      if (world.tree().nodes[node].child[lane] == accel::kEmptyChild)
        model_.empty_i = static_cast<std::uint8_t>(model_.empty_i | 1u << lane);
  }

  void compare_times(const intersect::SlabTimes& times) {
    const auto all = [&](const char* name, const std::uint32_t* twin, const float* model, int count) {
      for (int i = 0; i < count; ++i) difference_.same(name, twin[i], bits(model[i]));
    };
    all("t0", &model_.times_t0_o[0], times.t0, kLanes);
    all("t1", &model_.times_t1_o[0], times.t1, kLanes);
    if (!inner_) return;
    all("near_down", &model_.times_near_down_o[0], times.near_down[0], 3 * kLanes);
    all("near_up", &model_.times_near_up_o[0], times.near_up[0], 3 * kLanes);
    all("far_down", &model_.times_far_down_o[0], times.far_down[0], 3 * kLanes);
    all("far_up", &model_.times_far_up_o[0], times.far_up[0], 3 * kLanes);
  }

 private:
  VerilatedContext context_;
  Model model_{from_noise(context_)};
  bool inner_;
  Difference difference_;
};

std::uint32_t bits_of(const pipeline::NodeToken& token) {
  std::uint32_t bits = 0;
  BitWriter(&bits)
      .put(token.asked, 4)
      .put(token.order, 8)
      .put(token.survivors, 4)
      .put(token.hits, 4)
      .put(token.slot, kSlotBits);
  return bits;
}

struct Compared {
  std::string difference;
  std::uint64_t nodes = 0, hits = 0, decoded = 0;
};

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, int latency, std::uint64_t stall_seed) {
  pipeline::UnitConfig config = world.config();
  config.box_test.latency = latency;
  config.box_decode.latency = 2;
  Twin<Model> twin(config.mask_test.design != cull::Design::None);
  Model& model = twin.model();
  Difference& difference = twin.difference();
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().box_test;
  auto& source = run.unit().state().source;
  Compared compared;
  compared.difference = run.first_difference([&] {
    const pipeline::RefToken& token = stage.node.token;
    model.node_valid_i = stage.node.valid;
    model.node_data_i = static_cast<std::uint64_t>(token.slot) << 32 | token.ref;
    if (stage.node.valid) twin.set_node(world, token.ref);
    model.tested_ready_i = stage.tested.ready;
    model.eval();
    const auto& registers = source.registers(model.ray_slot_o % config.unit.contexts);
    twin.set_ray(registers.ray, registers.best.t);
    model.eval();
    difference.same("node pop", model.node_pop_o, stage.node.popped)
        .same("tested push", model.tested_push_o, stage.tested.pushed)
        .same("times written", model.times_write_o, stage.tested.pushed)
        .same("activity", model.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.node.popped) difference.same("slot of the boxes", model.boxes_slot_o, token.slot);
    if (model.decoded_write_o) {
      const auto& wanted = world.tree().nodes[source.registers(model.ray_slot_o).step.ref].boxes;
      for (int i = 0; i < 3 * kLanes; ++i)
        difference.same("decoded", model.decoded_boxes_o[i], bits(wanted.lo[i / kLanes][i % kLanes]))
            .same("decoded", model.decoded_boxes_o[3 * kLanes + i], bits(wanted.hi[i / kLanes][i % kLanes]));
      ++compared.decoded;
    }
    if (stage.tested.pushed) {
      const pipeline::NodeToken& tested = stage.tested.token;
      difference.same("tested", model.tested_data_o, bits_of(tested))
          .same("slot of the times", model.times_slot_o, tested.slot);
      twin.compare_times(source.registers(tested.slot).times);
      ++compared.nodes;
      compared.hits += tested.hits != 0;
    }
    clock(model);
    return difference.take();
  });
  return compared;
}

template <class Model>
void expect_equal(cull::Design design, int latency, std::uint32_t box_bits = accel::kFullBoxBits) {
  const test::World world("gen:tilted-quads?quads=200", design, 100, {}, box_bits);
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
    const Compared compared = compare<Model>(world, latency, stall_seed);
    EXPECT_EQ(compared.difference, "") << "latency " << latency << ", stall seed " << stall_seed;
    EXPECT_EQ(compared.nodes, world.counts().node_visits);
    EXPECT_EQ(compared.decoded, box_bits == accel::kFullBoxBits ? 0 : compared.nodes);
    EXPECT_GT(compared.hits, compared.nodes / 4);
  }
}

TEST(BoxTest, equals_the_model_in_every_cycle_at_every_latency_with_inner_bounds_and_without) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VBoxTest>(cull::Design::Projection, 11);
  expect_equal<VBoxTestOuter1>(cull::Design::None, 1);
  expect_equal<VBoxTestOuter6>(cull::Design::None, 6);
  expect_equal<VBoxTestOuter25>(cull::Design::None, 25);
}

TEST(BoxTest, equals_the_model_in_every_cycle_on_boxes_that_are_decoded_first) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VBoxTestCompact>(cull::Design::None, 3, 12);
}

/// Hostile boxes, one node a cycle, the exit refused in one cycle of four; the first difference.
template <class Model>
std::string compare_hostile(bool inner, int cases) {
  struct Inside {
    intersect::BoxCase box_case;
    intersect::SlabTimes times;
    pipeline::NodeToken token;
  };
  Twin<Model> twin(inner);
  Model& model = twin.model();
  intersect::HostileBoxes hostile(oracle::test_seed());
  std::mt19937_64 random(oracle::test_seed() + 1);
  std::deque<Inside> inside;  // the oldest first
  for (int entered = 0; entered < cases || !inside.empty();) {
    const intersect::BoxCase box_case = hostile.next();
    const intersect::PreparedRay ray = intersect::prepare_ray(box_case.ray);
    const auto slot = static_cast<pipeline::Slot>(random() % (1 << kSlotBits));
    model.node_valid_i = ray.valid && entered < cases;
    model.node_data_i = static_cast<std::uint64_t>(slot) << 32;
    twin.set_ray(ray, box_case.tmax);
    twin.set_boxes(reinterpret_cast<const std::uint8_t*>(&box_case.boxes));
    model.tested_ready_i = random() % 4 != 0;
    model.eval();
    if (model.node_pop_o) {
      const intersect::SlabTimes times = intersect::slab_test(ray, box_case.boxes, box_case.tmax);
      inside.push_back({box_case, times, {slot, times.hit, times.hit, 0, 0}});
      ++entered;
    }
    if (model.tested_push_o) {
      if (inside.empty()) return "a token leaves that never entered";
      const Inside& oldest = inside.front();
      twin.difference().same("tested", model.tested_data_o, bits_of(oldest.token));
      twin.compare_times(oldest.times);
      const std::string found = twin.difference().take();
      if (!found.empty()) return found + show(oldest.box_case, 0);
      inside.pop_front();
    }
    clock(model);
  }
  return "";
}

TEST(BoxTest, gives_the_bits_of_the_slab_test_on_hostile_boxes) {
  SCOPED_TRACE(oracle::seed_note());
  const int cases = std::getenv("CTU_LONG_TESTS") ? 200'000 : 20'000;
  EXPECT_EQ(compare_hostile<VBoxTest>(true, cases), "");
  EXPECT_EQ(compare_hostile<VBoxTestOuter1>(false, cases), "");
  EXPECT_EQ(compare_hostile<VBoxTestOuter25>(false, cases), "");
}

TEST(BoxTestMutants, boxes_with_two_axes_exchanged_are_caught) {
  EXPECT_NE(compare_hostile<VMutantBoxAxesSwapped>(false, 1000), "");
}
TEST(BoxTestMutants, a_slot_one_register_short_is_caught) {
  EXPECT_NE(compare_hostile<VMutantBoxSlotEarly>(false, 1000), "");
}

}  // namespace
}  // namespace ctu::rtl
