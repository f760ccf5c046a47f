// rtl/packet_cull.sv against the model's packet_cull within a unit at work: every handshake, the entries of every
// packet and the account in every cycle.
#include <gtest/gtest.h>

#include <cstring>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

#include "VMutantPacketDoubts.h"
#include "VPacketCull.h"
#include "VPacketCullCompact.h"
#include "VPacketCullParallel.h"
#include "model/accel/build.h"
#include "model/accel/forest.h"
#include "model/numeric/round.h"
#include "model/scene/load.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using numeric::bits;
using reference::PacketPlan;

constexpr int kSlotBits = 5;

/// How a twin is built.
struct Shape {
  int packets, entries, latency, interval, decode_latency;
  int packet_bits() const { return packets <= 2 ? 1 : std::bit_width(static_cast<unsigned>(packets - 1)); }
};
constexpr Shape kSerial{8, 8, 12, 4, 0}, kParallel{1, 1, 1, 1, 0}, kCompact{5, 16, 25, 2, 2}, kBroken{8, 8, 2, 3, 0};

struct Compared {
  std::string difference;
  std::uint64_t joined = 0, nodes = 0, starts = 0, entries = 0, without_entries = 0;
  std::uint64_t cycles_of[pipeline::kActivities] = {};
};

/// A Verilated packet_cull beside the stage of a unit.
template <class Model>
class Twin {
 public:
  Twin(const Shape& shape, const test::World& world, const pipeline::UnitConfig& config, pipeline::TappedUnit& unit)
      : shape_(shape), world_(world), unit_(unit), node_of_(static_cast<std::size_t>(config.unit.contexts)) {
    model_.packets_i = static_cast<std::uint8_t>(config.packet_cull.packets);
    model_.most_entries_i = static_cast<std::uint8_t>(world.packets().most_entries);
    model_.interval_i = static_cast<std::uint8_t>(config.packet_cull.interval);
    reset(model_);
  }

  /// Behind a cycle of the unit: the same cycle of the twin. The first difference, or nothing.
  std::string cycle(Compared& compared) {
    auto& stage = *unit_.stages().packet_cull;
    if (stage.nodes.valid) node_of_[stage.nodes.token.slot] = stage.nodes.token.ref;
    set_links(stage);
    model_.eval();
    set_ray();
    set_node();
    model_.eval();
    compare(stage, compared);
    clock(model_);
    return difference_.take();
  }

 private:
  template <class Stage>
  void set_links(const Stage& stage) {
    const pipeline::JoinToken& ray = stage.rays.token;
    model_.rays_valid_i = stage.rays.valid;
    model_.rays_data_i = static_cast<std::uint8_t>(ray.slot << 2 | unsigned{ray.joins} << 1 | unsigned{ray.closes});
    model_.nodes_valid_i = stage.nodes.valid;
    model_.nodes_data_i = static_cast<std::uint64_t>(stage.nodes.token.slot) << 32 | stage.nodes.token.ref;
    model_.released_valid_i = stage.released.valid;
    model_.released_data_i = stage.released.token.packet;
    model_.to_scheduler_ready_i = stage.to_scheduler.ready;
    model_.starts_ready_i = stage.starts.ready;
    model_.entries_packet_i = model_.count_packet_i = stage.starts.token.packet;
  }

  void set_ray() {
    if (model_.ray_slot_o >= node_of_.size()) return;
    const intersect::PreparedRay& ray = unit_.state().source.registers(model_.ray_slot_o).ray;
    const auto put = [](std::uint32_t* words, const Vec3& vector) {
      BitWriter(words).put(vector[0]).put(vector[1]).put(vector[2]);
    };
    put(&model_.ray_origin_i[0], ray.ray.origin);
    put(&model_.ray_rcp_down_i[0], ray.rcp_down);
    put(&model_.ray_rcp_up_i[0], ray.rcp_up);
    model_.ray_zero_axes_i = ray.zero_axes;
    model_.ray_negative_axes_i = ray.negative_axes;
    model_.ray_tmin_i = bits(ray.ray.tmin);
    model_.ray_tmax_i = bits(ray.ray.tmax);
    model_.ray_root_i = unit_.state().contexts[model_.ray_slot_o].root;
  }

  /// The nodes that the contexts hold, as node_fetch has them.
  void set_node() {
    const accel::Image& image = world_.image();
    if (model_.boxes_slot_o < node_of_.size()) {
      const std::uint32_t node = node_of_[model_.boxes_slot_o];
      const std::uint8_t* const bytes = &image.bytes[image.node_address(node)];
      auto* const boxes = &model_.boxes_i[0];
      if (image.layout.box_bits == accel::kFullBoxBits) {
        std::memcpy(boxes, bytes, 96);
      } else {  // children lie between frame and planes
        std::memcpy(boxes, bytes, 16);
        std::memcpy(boxes + 4, bytes + 32, 3 * image.layout.box_bits);
      }
      model_.empty_i = static_cast<std::uint8_t>(~reference::lanes_of(unit_.state().image.children(node)) & 15u);
    }
    if (model_.children_slot_o < node_of_.size())
      for (unsigned lane = 0; lane < 4; ++lane)
        model_.children_i[lane] = unit_.state().image.children(node_of_[model_.children_slot_o])[lane];
  }

  template <class Stage>
  void compare(const Stage& stage, Compared& compared) {
    difference_.same("rays pop", model_.rays_pop_o, stage.rays.popped)
        .same("nodes pop", model_.nodes_pop_o, stage.nodes.popped)
        .same("released pop", model_.released_pop_o, stage.released.popped)
        .same("to_scheduler push", model_.to_scheduler_push_o, stage.to_scheduler.pushed)
        .same("starts push", model_.starts_push_o, stage.starts.pushed)
        .same("activity", model_.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.to_scheduler.pushed) {
      const pipeline::RefToken& token = stage.to_scheduler.token;
      difference_.same("to_scheduler", model_.to_scheduler_data_o,
                       static_cast<std::uint64_t>(token.slot) << 32 | token.ref);
    }
    if (stage.starts.pushed) compare_start(stage.starts.token, compared);
    compared.joined += stage.rays.popped && stage.rays.token.joins;
    compared.nodes += stage.nodes.popped;
    ++compared.cycles_of[static_cast<int>(stage.account.current())];
  }

  void compare_start(const pipeline::StartToken& token, Compared& compared) {
    const unsigned number = token.packet, bits_of_number = static_cast<unsigned>(shape_.packet_bits());
    difference_.same("starts", model_.starts_data_o,
                     (token.slot << bits_of_number | number) << 1 | unsigned{token.last});
    const reference::EntryList& entries = unit_.state().packets[token.packet].entries;
    difference_.same("count", model_.count_o, static_cast<unsigned>(entries.count()));
    const auto* words = reinterpret_cast<const std::uint32_t*>(&model_.entries_o);
    for (int i = 0; i < entries.count(); ++i)
      difference_.same("entry", words[2 * i], entries[i].ref).same("entry's t", words[2 * i + 1], bits(entries[i].t0));
    ++compared.starts;
    compared.entries += static_cast<unsigned>(entries.count());
    compared.without_entries += entries.count() == 0;
  }

  const Shape shape_;
  const test::World& world_;
  pipeline::TappedUnit& unit_;
  std::vector<std::uint32_t> node_of_;  ///< by context, of packets
  Difference difference_;
  VerilatedContext context_;
  Model model_{from_noise(context_)};
};

template <class Model>
Compared compare(const Shape& shape, const test::World& world, const pipeline::UnitConfig& config,
                 std::uint64_t stall_seed) {
  StageRun run(world, config, stall_seed);
  Twin<Model> twin(shape, world, config, run.unit());
  Compared compared;
  compared.difference = run.first_difference([&] { return twin.cycle(compared); });
  return compared;
}

/// Bundles of lines from about one point to about another, along axes too, some beside the scene; some rays not valid.
std::vector<intersect::Ray> bundles(const accel::Bvh4& tree, int count, int bundle) {
  std::mt19937_64 random(oracle::test_seed());
  const auto uniform = [&] { return static_cast<float>(random() >> 40) * 0x1p-24f; };
  std::vector<intersect::Ray> rays(static_cast<std::size_t>(count));
  Vec3 from, to;
  float spread = 0;
  for (int i = 0; i < count; ++i) {
    if (i % bundle == 0) {
      for (int axis = 0; axis < 3; ++axis) {
        const float size = tree.upper[axis] - tree.lower[axis];
        from[axis] = tree.lower[axis] + size * (3 * uniform() - 1);
        to[axis] = tree.lower[axis] + size * uniform();
      }
      if (i / bundle % 4 == 1) to[i / bundle % 3] = from[i / bundle % 3];
      if (i / bundle % 7 == 6)
        for (int axis = 0; axis < 3; ++axis) to[axis] = 2 * from[axis] - to[axis];
      spread = i / bundle % 3 == 0 ? 0.3f : 0.02f;
    }
    intersect::Ray& ray = rays[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      const float size = tree.upper[axis] - tree.lower[axis];
      ray.origin[axis] = from[axis] + (i % 2 == 0 ? 0.01f * size * uniform() : 0.0f);
      ray.direction[axis] = to[axis] - from[axis] + (to[axis] == from[axis] ? 0.0f : spread * size * uniform());
    }
    ray.tmax = i % 3 == 0 ? 1.5f : std::numeric_limits<float>::infinity();
    if (i % 4 == 1) ray.kind = intersect::RayKind::AnyHit;
    if (i % 11 == 10 || (i % bundle == bundle - 1 && i % 3 == 0) || i / bundle == 5) ray.direction = {};
  }
  return rays;
}

test::World world_of(const PacketPlan& plan, std::uint32_t box_bits = accel::kFullBoxBits, bool several_trees = false) {
  const scene::Mesh mesh = scene::load("gen:hair-ball?strands=150").mesh;
  accel::Bvh4 tree = accel::build(mesh, {});
  const std::vector<intersect::Ray> rays = bundles(tree, 400, plan.size);
  if (several_trees)
    for (const int leaf : {1, 3}) accel::append_tree(tree, accel::build(mesh, {.max_leaf_triangles = leaf}));
  test::World world(std::move(tree), cull::Design::None, rays, {}, box_bits);
  if (several_trees) world.walk_trees(std::vector<std::uint8_t>{0, 0, 0, 0, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 0, 1});
  world.travel_in(plan);
  return world;
}

pipeline::UnitConfig config_of(const test::World& world, const Shape& shape, int packets, int interval) {
  pipeline::UnitConfig config = world.config();
  config.ray_setup.interval = 1;
  config.packet_cull = {.packets = packets, .latency = shape.latency, .interval = interval};
  config.box_decode.latency = shape.decode_latency == 0 ? config.box_decode.latency : shape.decode_latency;
  return config;
}

/// With free links and with links that refuse at random; the stalls that it has must have occurred.
template <class Model>
void expect_equal(const Shape& shape, const test::World& world, int packets, int interval) {
  SCOPED_TRACE(oracle::seed_note());
  std::uint64_t cycles_of[pipeline::kActivities] = {};
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
    const Compared compared = compare<Model>(shape, world, config_of(world, shape, packets, interval), stall_seed);
    EXPECT_EQ(compared.difference, "") << packets << " packets, interval " << interval << ", stall seed " << stall_seed;
    EXPECT_GT(compared.joined, 250u);
    EXPECT_EQ(compared.starts, compared.joined);
    EXPECT_GT(compared.nodes, 40u);
    EXPECT_GT(compared.entries, compared.starts / 2);
    EXPECT_GT(compared.without_entries, 10u);
    for (int i = 0; i < pipeline::kActivities; ++i) cycles_of[i] += compared.cycles_of[i];
  }
  EXPECT_GT(cycles_of[static_cast<int>(pipeline::Activity::OutputFull)], 0u);
  if (packets == 1) {
    EXPECT_GT(cycles_of[static_cast<int>(pipeline::Activity::NoPacket)], 100u);
  }
}

TEST(PacketCull, equals_the_model_with_one_lane_in_packets_of_16) {
  const test::World world = world_of({16, 8});
  expect_equal<VPacketCull>(kSerial, world, 8, 4);
  expect_equal<VPacketCull>(kSerial, world, 3, 13);
}
TEST(PacketCull, equals_the_model_in_packets_of_4_with_three_entries) {
  expect_equal<VPacketCull>(kSerial, world_of({4, 3}), 5, 5);
}
TEST(PacketCull, equals_the_model_with_four_lanes_one_packet_and_one_entry_at_latency_1) {
  const test::World world = world_of({8, 1});
  expect_equal<VPacketCullParallel>(kParallel, world, 1, 1);
  expect_equal<VPacketCullParallel>(kParallel, world, 1, 3);
}
TEST(PacketCull, equals_the_model_with_two_lanes_and_boxes_of_reduced_precision) {
  const test::World world = world_of({32, 16}, 12);
  expect_equal<VPacketCullCompact>(kCompact, world, 5, 2);
  expect_equal<VPacketCullCompact>(kCompact, world, 1, 3);
}
TEST(PacketCull, equals_the_model_when_packets_walk_several_trees) {
  const test::World world = world_of({32, 16}, 12, true);
  expect_equal<VPacketCullCompact>(kCompact, world, 5, 2);
}

TEST(PacketCullMutants, a_node_that_gives_way_to_two_children_in_doubt_is_caught) {
  SCOPED_TRACE(oracle::seed_note());
  const test::World world = world_of({16, 8});
  const Compared compared = compare<VMutantPacketDoubts>(kBroken, world, config_of(world, kBroken, 8, 3), 0);
  EXPECT_NE(compared.difference, "");
  std::cout << compared.difference << '\n';
}

}  // namespace
}  // namespace ctu::rtl
