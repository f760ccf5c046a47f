// rtl/ray_queue.sv against pipeline::RayQueue in a whole unit, in every cycle, and by itself against
// intersect::prepare_ray on rays meant to break it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <map>
#include <random>
#include <sstream>

#include "VMutantRayEmptyRange.h"
#include "VMutantRayFirstTree.h"
#include "VMutantRayFreedFirst.h"
#include "VMutantRayTiedAxes.h"
#include "VMutantRayUnswappedAxes.h"
#include "VRayQueue.h"
#include "VRayQueueParallel.h"
#include "VRayQueueSerial.h"
#include "VRayQueueShort.h"
#include "model/accel/build.h"
#include "model/accel/forest.h"
#include "model/numeric/round.h"
#include "model/scene/load.h"
#include "tests/intersect/hostile_boxes.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using intersect::PreparedRay;
using intersect::Ray;
using numeric::bits;
using pipeline::UnitConfig;

constexpr int kTrees = 3;  ///< of the models that have several

/// Rays that walk each one of so many trees.
test::World make_world(int trees) {
  const scene::Mesh mesh = scene::load("gen:hair-ball?strands=60").mesh;
  accel::Bvh4 tree = accel::build(mesh, {});
  for (int i = 1; i < trees; ++i) accel::append_tree(tree, accel::build(mesh, {.max_leaf_triangles = i}));
  test::World world(std::move(tree), cull::Design::None, 400);
  if (trees > 1) world.walk_trees({0, 2, 1, 1, 2});
  return world;
}

const test::World& world_of(int trees) {
  static const test::World one = make_world(1), several = make_world(kTrees);
  return trees == 1 ? one : several;
}

/// A Verilated ray_queue; differences from what should be are collected.
template <class Model>
class QueueTwin {
 public:
  QueueTwin(int contexts, int interval) {
    model_.contexts_i = static_cast<std::uint16_t>(contexts);
    model_.interval_i = static_cast<std::uint8_t>(interval);
    reset(model_);
  }
  Model& model() { return model_; }

  void offer(const Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      model_.ray_origin_i[axis] = bits(ray.origin[axis]);
      model_.ray_direction_i[axis] = bits(ray.direction[axis]);
    }
    model_.ray_tmin_i = bits(ray.tmin);
    model_.ray_tmax_i = bits(ray.tmax);
  }
  void offer_tree(std::uint32_t tree) { model_.ray_tree_i = static_cast<std::uint8_t>(tree); }

  /// Before rays come.
  void load_roots(const accel::Image& image) {
    for (std::uint32_t tree = 0; tree < image.trees(); ++tree) {
      model_.root_write_i = 1;
      model_.root_tree_i = static_cast<std::uint8_t>(tree);
      model_.root_i = image.root(tree);
      clock(model_);
    }
    model_.root_write_i = 0;
  }

  /// A cycle up to its end, in which the file of roots by context answers as well.
  void eval() {
    model_.eval();
    model_.setup_root_i = root_of_[model_.setup_slot_o];
    model_.eval();
  }
  void end_cycle() {
    if (model_.ray_take_o) root_of_[model_.ray_slot_o] = model_.ray_root_o;
    clock(model_);
  }

  /// What is written as the ray is taken.
  void compare_axes(const PreparedRay& ray) {
    if (!ray.valid) return;
    same("zero axes", model_.ray_zero_axes_o, ray.zero_axes);
    same("negative axes", model_.ray_negative_axes_o, ray.negative_axes);
    same("kx", model_.ray_kx_o, ray.kx);
    same("ky", model_.ray_ky_o, ray.ky);
    same("kz", model_.ray_kz_o, ray.kz);
  }
  /// What is written as it leaves.
  void compare_quotients(const PreparedRay& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      same("rcp_down", model_.setup_rcp_down_o[axis], bits(ray.rcp_down[axis]));
      same("rcp_up", model_.setup_rcp_up_o[axis], bits(ray.rcp_up[axis]));
    }
    same("sx", model_.setup_sx_o, bits(ray.sx));
    same("sy", model_.setup_sy_o, bits(ray.sy));
  }

  void same(const char* port, std::uint64_t twin, std::uint64_t should) {
    if (twin == should) return;
    difference_ << port << ": the twin 0x" << std::hex << twin << ", should be 0x" << should << "; ";
  }
  std::string difference() const { return difference_.str(); }

 private:
  std::ostringstream difference_;
  std::array<std::uint32_t, 256> root_of_{};
  VerilatedContext context_;
  Model model_{from_noise(context_)};
};

/// Ends at the first difference, which it returns.
template <class Model>
std::string difference_in_unit(const UnitConfig& config, std::uint64_t stall_seed, int trees) {
  const test::World& world = world_of(trees);
  std::vector<Ray> rays;
  std::vector<std::uint32_t> tree_of;
  for (const auto& block : world.blocks())
    for (std::size_t i = 0; i < block->rays.size(); ++i) {
      rays.push_back(block->rays[i]);
      tree_of.push_back(reference::tree_of(block->trees, i));
    }
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().ray_queue;
  auto& state = run.unit().state();
  QueueTwin<Model> twin(config.unit.contexts, config.ray_setup.interval);
  twin.load_roots(world.image());
  Model& model = twin.model();
  std::uint64_t taken = 0;
  run.each_cycle([&](Cycle now) {
    if (!twin.difference().empty()) return;
    model.ray_valid_i = taken < rays.size();
    if (taken < rays.size()) {
      twin.offer(rays[taken]);
      twin.offer_tree(tree_of[taken]);
    }
    model.freed_valid_i = stage.freed.valid;
    model.freed_data_i = static_cast<std::uint8_t>(stage.freed.token.slot);
    model.to_scheduler_ready_i = stage.to_scheduler.ready;
    model.to_result_ready_i = stage.to_result.ready;
    twin.eval();

    twin.same("ray_take", model.ray_take_o, stage.rays_taken() != taken);
    twin.same("freed_pop", model.freed_pop_o, stage.freed.popped);
    twin.same("to_scheduler_push", model.to_scheduler_push_o, stage.to_scheduler.pushed);
    twin.same("to_result_push", model.to_result_push_o, stage.to_result.pushed);
    twin.same("setup_write", model.setup_write_o, stage.to_scheduler.pushed);
    twin.same("activity", model.activity_o, static_cast<std::uint64_t>(stage.account.current()));
    if (stage.rays_taken() != taken) {
      const pipeline::Context& context = state.contexts[model.ray_slot_o];
      twin.same("the ray in the context taken", context.ray, taken);
      twin.same("the cycle it was taken", context.entered, now);
      twin.same("its root", model.ray_root_o, context.root);
      twin.compare_axes(state.source.registers(model.ray_slot_o).ray);
      taken = stage.rays_taken();
    }
    if (stage.to_scheduler.pushed) {
      const pipeline::RefToken& token = stage.to_scheduler.token;
      twin.same("to_scheduler", model.to_scheduler_data_o, std::uint64_t{token.slot} << 32 | token.ref);
      twin.same("setup_slot", model.setup_slot_o, token.slot);
      twin.compare_quotients(state.source.registers(token.slot).ray);
    }
    if (stage.to_result.pushed) twin.same("to_result", model.to_result_data_o, stage.to_result.token.slot);
    twin.end_cycle();
  });
  EXPECT_TRUE(taken == rays.size() || !twin.difference().empty()) << taken << " rays taken";
  return twin.difference();
}

UnitConfig config_of(int contexts, int latency, int interval) {
  UnitConfig config = world_of(1).config();
  config.unit.contexts = contexts;
  config.ray_setup = {.latency = latency, .interval = interval};
  config.memory.model = pipeline::MemoryModel::Ideal;
  config.memory.latency = 10;
  config.memory.interval = 1;
  return config;
}

template <class Model>
void expect_equal(int contexts, int latency, int interval, int trees = 1) {
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
    SCOPED_TRACE(testing::Message() << contexts << " contexts, latency " << latency << ", interval " << interval << ", "
                                    << trees << " trees, stall seed " << stall_seed);
    EXPECT_EQ(difference_in_unit<Model>(config_of(contexts, latency, interval), stall_seed, trees), "");
  }
}

TEST(RayQueue, does_in_every_cycle_what_the_model_does_with_two_dividers) {
  expect_equal<VRayQueue>(32, 20, 3);
  expect_equal<VRayQueue>(3, 20, 3);
  expect_equal<VRayQueue>(20, 20, 4);
  expect_equal<VRayQueue>(1, 20, 100);
}
TEST(RayQueue, does_so_with_five_dividers_and_one_register) {
  expect_equal<VRayQueueParallel>(256, 1, 1);
  expect_equal<VRayQueueParallel>(4, 1, 1);
  expect_equal<VRayQueueParallel>(30, 1, 2);
}
TEST(RayQueue, sends_each_ray_to_the_root_of_its_tree) {
  expect_equal<VRayQueueParallel>(30, 1, 2, kTrees);
  expect_equal<VRayQueueParallel>(4, 1, 1, kTrees);
}
TEST(RayQueue, does_so_with_three_dividers) {
  expect_equal<VRayQueueShort>(4, 6, 2);
  expect_equal<VRayQueueShort>(3, 6, 5);
}
TEST(RayQueue, does_so_with_one_divider) {
  expect_equal<VRayQueueSerial>(8, 41, 7);
  expect_equal<VRayQueueSerial>(5, 41, 9);
}

/// Rays with everything that prepare_ray has to tell apart.
class HostileRays {
 public:
  explicit HostileRays(std::uint64_t seed) : boxes_(seed), random_(seed + 1) {}

  Ray next() {
    Ray ray = boxes_.next().ray;
    float* const fields[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z, &ray.direction.x,
                             &ray.direction.y, &ray.direction.z, &ray.tmin,     &ray.tmax};
    if (chance(4))  // components of the same size
      for (int axis = 1; axis < 3; ++axis)
        if (chance(2)) ray.direction[axis] = chance(2) ? ray.direction[0] : -ray.direction[0];
    if (chance(8)) ray.tmax = ray.tmin;
    if (chance(3)) *fields[random_() % 8] = numeric::from_bits(static_cast<std::uint32_t>(random_()));
    if (chance(3)) *fields[random_() % 8] = kSpecial[random_() % std::size(kSpecial)];
    return ray;
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static constexpr float kSpecial[] = {0.0f,
                                       -0.0f,
                                       kInfinity,
                                       -kInfinity,
                                       std::numeric_limits<float>::quiet_NaN(),
                                       std::numeric_limits<float>::denorm_min(),
                                       -std::numeric_limits<float>::denorm_min(),
                                       std::numeric_limits<float>::min(),
                                       std::numeric_limits<float>::max(),
                                       -std::numeric_limits<float>::max()};
  bool chance(unsigned of) { return random_() % of == 0; }

  intersect::HostileBoxes boxes_;
  std::mt19937_64 random_;
};

std::string show(const Ray& ray) {
  char text[160];
  std::snprintf(text, sizeof text, "origin %08x %08x %08x, direction %08x %08x %08x, t %08x %08x", bits(ray.origin.x),
                bits(ray.origin.y), bits(ray.origin.z), bits(ray.direction.x), bits(ray.direction.y),
                bits(ray.direction.z), bits(ray.tmin), bits(ray.tmax));
  return text;
}

struct HostileRun {
  std::uint64_t accepted = 0, refused = 0;
  std::string difference;  ///< empty: none
};

/// `count` hostile rays through the twin alone, whose links refuse at random; contexts are freed at random.
template <class Model>
HostileRun run_hostile(int contexts, int interval, std::uint64_t count) {
  HostileRays rays(oracle::test_seed());
  std::mt19937_64 random(oracle::test_seed() + 2);
  QueueTwin<Model> twin(contexts, interval);
  Model& model = twin.model();
  HostileRun run;
  std::map<int, Ray> inside;  // by context
  std::vector<int> to_free;
  Ray ray = rays.next();
  while (run.accepted + run.refused < count) {
    model.ray_valid_i = random() % 8 != 0;
    twin.offer(ray);
    model.freed_valid_i = !to_free.empty() && random() % 2 != 0;
    if (!to_free.empty()) model.freed_data_i = static_cast<std::uint8_t>(to_free.back());
    model.to_scheduler_ready_i = random() % 8 != 0;
    model.to_result_ready_i = random() % 8 != 0;
    twin.eval();
    Ray concerned = ray;
    if (model.freed_valid_i) to_free.pop_back();
    if (model.to_scheduler_push_o || model.to_result_push_o) {
      const int slot = model.to_scheduler_push_o ? static_cast<int>(model.to_scheduler_data_o >> 32)
                                                 : static_cast<int>(model.to_result_data_o);
      const PreparedRay prepared = prepare_ray(inside.at(slot));
      twin.same("accepted", model.to_scheduler_push_o, prepared.valid);
      if (prepared.valid && model.to_scheduler_push_o) twin.compare_quotients(prepared);
      ++(prepared.valid ? run.accepted : run.refused);
      concerned = inside.at(slot);
      inside.erase(slot);
      to_free.push_back(slot);
    }
    if (model.ray_take_o && twin.difference().empty()) {
      twin.same("context in use", inside.count(model.ray_slot_o), 0);
      twin.compare_axes(prepare_ray(ray));
      concerned = ray;
      inside[model.ray_slot_o] = ray;
      ray = rays.next();
    }
    twin.end_cycle();
    if (twin.difference().empty()) continue;
    run.difference = twin.difference() + show(concerned);
    break;
  }
  return run;
}

template <class Model>
void expect_prepared(int contexts, int interval) {
  SCOPED_TRACE(oracle::seed_note());
  const std::uint64_t count = std::getenv("CTU_LONG_TESTS") ? 2'000'000 : 100'000;
  const HostileRun run = run_hostile<Model>(contexts, interval, count);
  EXPECT_EQ(run.difference, "");
  EXPECT_GT(run.accepted, count / 3);
  EXPECT_GT(run.refused, count / 20);
}

TEST(RayQueue, prepares_hostile_rays_to_the_bit_with_two_dividers) { expect_prepared<VRayQueue>(32, 3); }
TEST(RayQueue, prepares_hostile_rays_to_the_bit_with_five_dividers) { expect_prepared<VRayQueueParallel>(9, 1); }
TEST(RayQueue, prepares_hostile_rays_to_the_bit_with_three_dividers) { expect_prepared<VRayQueueShort>(4, 2); }

template <class Model>
void expect_caught_as_it_prepares() {
  const HostileRun run = run_hostile<Model>(8, 5, 20'000);
  EXPECT_NE(run.difference, "");
  std::cout << "ray " << run.accepted + run.refused << ", " << run.difference << '\n';
}

TEST(RayQueueMutants, contexts_given_again_before_new_ones_are_caught) {
  const std::string difference = difference_in_unit<VMutantRayFreedFirst>(config_of(8, 2, 100), 0, kTrees);
  EXPECT_NE(difference, "");
  std::cout << difference << '\n';
}
TEST(RayQueueMutants, all_rays_in_the_first_tree_are_caught) {
  const std::string difference = difference_in_unit<VMutantRayFirstTree>(config_of(8, 2, 5), 0, kTrees);
  EXPECT_NE(difference.find("its root"), std::string::npos) << difference;
}
TEST(RayQueueMutants, a_ray_of_one_point_refused_is_caught) { expect_caught_as_it_prepares<VMutantRayEmptyRange>(); }
TEST(RayQueueMutants, the_first_of_equal_components_chosen_is_caught) {
  expect_caught_as_it_prepares<VMutantRayTiedAxes>();
}
TEST(RayQueueMutants, axes_not_exchanged_for_a_ray_that_runs_down_are_caught) {
  expect_caught_as_it_prepares<VMutantRayUnswappedAxes>();
}

}  // namespace
}  // namespace ctu::rtl
