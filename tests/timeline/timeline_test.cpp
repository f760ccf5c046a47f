// A timeline shows every cycle of every ray and stage as the accounts have it, cuts nothing but its window, and changes
// nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "model/accel/build.h"
#include "model/pipeline/timeline.h"
#include "model/scene/load.h"
#include "model/unit/run.h"
#include "sim/timeline/kanata_log.h"
#include "sim/timeline/perfetto_trace.h"
#include "tests/pipeline/world.h"
#include "tests/timeline/kanata_reader.h"
#include "tests/timeline/perfetto_reader.h"

namespace ctu::test {
namespace {

using cull::Design;
using pipeline::Cycle;
using pipeline::Place;
using pipeline::RayStay;
using pipeline::Timeline;
using pipeline::UnitConfig;
using pipeline::UnitResult;

constexpr Cycle kWhole = 1'000'000;

/// A unit with all of the parts that some units leave out, or with none.
struct Case {
  std::string name;
  Design design = Design::Projection;
  bool spheres = false, primitive_boxes = false, packets = false, table_cache = false, small_stack = false;
};
const std::vector<Case> kCases = {
    {.name = "no culling", .design = Design::None},
    {.name = "projection"},
    {.name = "comparators, stack of one", .design = Design::Comparators, .small_stack = true},
    {.name = "cached tables", .design = Design::MaskLut, .table_cache = true},
    {.name = "spheres and ray boxes", .spheres = true, .primitive_boxes = true},
    {.name = "packets", .packets = true}};

World& world_of(const Case& c) {
  static std::map<std::string, std::unique_ptr<World>> worlds;
  auto& world = worlds[c.name];
  if (world) return *world;
  scene::Mesh mesh = scene::load("gen:hair-ball?strands=60").mesh;
  if (c.spheres) add_spheres(mesh);
  world = std::make_unique<World>(accel::build(mesh, {.triangle_cost = c.primitive_boxes ? 0.01f : 1.0f}), c.design, 90,
                                  cull::MaskOptions{}, accel::kFullBoxBits, c.primitive_boxes);
  if (c.packets) world->travel_in({8, 3});
  return *world;
}

UnitConfig config_of(const Case& c) {
  UnitConfig config = world_of(c).config();
  config.unit.contexts = 12;
  if (c.small_stack) config.stack = {.entries = 1, .push_width = 1, .spill_batch = 1};
  if (c.table_cache) config.table_cache = {.bytes = 2048, .ways = 2, .hit_latency = 4, .ports = 1, .mshrs = 3};
  return config;
}

struct Watched {
  UnitResult result;
  Timeline timeline;
};
Watched watch(const Case& c, Cycle first = 0, Cycle last = kWhole, bool exec = false) {
  Watched watched{{}, Timeline(first, last)};
  watched.result = world_of(c).run(config_of(c), {.exec = exec, .timeline = &watched.timeline});
  return watched;
}

std::map<std::string, std::uint64_t> ray_cycles(const UnitResult& result) {
  std::map<std::string, std::uint64_t> cycles;
  for (const auto& cause : result.ray_cycles)
    if (cause.cycles != 0) cycles[cause.name] = cause.cycles;
  return cycles;
}

using StayKey = std::tuple<std::uint64_t, int, int, Cycle, Cycle, bool, bool>;
/// A fetch that the window cuts may miss a line later.
Place place_by(const RayStay& stay, Cycle end) {
  if (stay.end < end) return stay.place;
  return stay.place == Place::NodeFetchMiss    ? Place::NodeFetchHit
         : stay.place == Place::LeafFetchMiss  ? Place::LeafFetchHit
         : stay.place == Place::TableFetchMiss ? Place::TableFetchHit
                                               : stay.place;
}
StayKey key_of(const RayStay& s) {
  return {s.ray, s.slot, static_cast<int>(s.place), s.begin, s.end, s.enters, s.leaves};
}

/// Which place may come behind which.
const std::map<std::string, std::set<std::string>> kNext = {
    {"ray_setup", {"scheduler", "result", "packet_cull"}},
    {"packet_cull", {"scheduler", "traversal_stack"}},
    {"scheduler", {"node_fetch_hit", "node_fetch_miss", "leaf_fetch_hit", "leaf_fetch_miss"}},
    {"node_fetch_hit", {"box_test", "packet_cull"}},
    {"node_fetch_miss", {"box_test", "packet_cull"}},
    {"box_test", {"cell_locate", "child_sort"}},
    {"cell_locate", {"table_fetch_hit", "table_fetch_miss", "mask_test"}},
    {"table_fetch_hit", {"mask_test"}},
    {"table_fetch_miss", {"mask_test"}},
    {"mask_test", {"child_sort"}},
    {"child_sort", {"traversal_stack"}},
    {"traversal_stack", {"scheduler", "stack_refill", "result"}},
    {"stack_refill", {"traversal_stack"}},
    {"leaf_fetch_hit", {"primitive_cull", "triangle_test"}},
    {"leaf_fetch_miss", {"primitive_cull", "triangle_test"}},
    {"primitive_cull", {"triangle_test", "hit_update"}},
    {"triangle_test", {"sphere_test", "hit_update"}},
    {"sphere_test", {"hit_update"}},
    {"hit_update", {"traversal_stack"}},
    {"result", {}}};

TEST(Timeline, changes_no_result) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const UnitResult alone = world_of(c).run(config_of(c)), watched = watch(c, 100, 900).result;
    EXPECT_EQ(watched.cycles, alone.cycles);
    EXPECT_EQ(watched.event_log_hash, alone.event_log_hash);
    EXPECT_EQ(watched.wrong_hits, 0u);
    EXPECT_EQ(ray_cycles(watched), ray_cycles(alone));
    for (std::size_t i = 0; i < alone.stages.size(); ++i) EXPECT_EQ(watched.stages[i].busy, alone.stages[i].busy);
  }
}

TEST(Timeline, of_a_whole_run_adds_up_to_the_ray_latency_accounts) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const auto [result, timeline] = watch(c);
    std::map<std::string, std::uint64_t> cycles;
    std::map<std::uint64_t, int> entered, left;
    std::map<std::uint64_t, Cycle> at;
    for (const RayStay& stay : timeline.stays()) {
      cycles[std::string(name_of(stay.place))] += stay.end - stay.begin;
      entered[stay.ray] += stay.enters;
      left[stay.ray] += stay.leaves;
      EXPECT_TRUE(stay.enters || stay.begin == at[stay.ray]) << "a gap in the way of ray " << stay.ray;
      at[stay.ray] = stay.end;
    }
    EXPECT_EQ(cycles, ray_cycles(result));
    ASSERT_EQ(entered.size(), result.rays);
    for (const auto& [ray, times] : entered) EXPECT_EQ(times, 1) << ray;
    for (const auto& [ray, times] : left) EXPECT_EQ(times, 1) << ray;
  }
}

TEST(Timeline, of_a_whole_run_adds_up_to_the_accounts_of_the_stages) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const auto [result, timeline] = watch(c);
    std::vector<std::map<std::string, std::uint64_t>> cycles(timeline.stages().size());
    for (const auto& span : timeline.stage_spans())
      cycles[static_cast<std::size_t>(span.stage)][std::string(name_of(span.activity))] += span.end - span.begin;
    ASSERT_EQ(result.stages.size(), timeline.stages().size());
    for (std::size_t i = 0; i < result.stages.size(); ++i) {
      SCOPED_TRACE(result.stages[i].stage);
      EXPECT_EQ(timeline.stages()[i], result.stages[i].stage);
      EXPECT_EQ(cycles[i]["busy"], result.stages[i].busy);
      EXPECT_EQ(cycles[i]["idle"], result.stages[i].idle);
      for (const auto& cause : result.stages[i].stalled) EXPECT_EQ(cycles[i][cause.name], cause.cycles) << cause.name;
    }
  }
}

TEST(Timeline, of_a_window_is_that_of_the_whole_run_cut) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const auto [result, whole] = watch(c);
    const Cycle first = result.cycles / 3, last = 2 * result.cycles / 3;
    const Timeline cut = watch(c, first, last).timeline;
    std::set<StayKey> expected, found;
    for (RayStay stay : whole.stays()) {
      if (stay.end <= first || stay.begin > last) continue;
      stay.enters &= stay.begin >= first;
      stay.leaves &= stay.end <= last;
      stay.begin = std::max(stay.begin, first);
      stay.end = std::min(stay.end, last + 1);
      stay.place = place_by(stay, last + 1);
      expected.insert(key_of(stay));
    }
    for (RayStay stay : cut.stays()) {
      stay.place = place_by(stay, last + 1);
      found.insert(key_of(stay));
    }
    EXPECT_FALSE(found.empty());
    EXPECT_EQ(found, expected);
    std::vector<pipeline::Event> events;
    for (const auto& event : whole.events())
      if (cut.wants(event.cycle)) events.push_back(event);
    EXPECT_FALSE(events.empty());
    EXPECT_EQ(cut.events(), events);
  }
}

TEST(Timeline, is_the_same_in_every_mode_and_from_every_source) {
  for (const Case& c : {kCases[1], kCases[3]}) {
    const World& world = world_of(c);
    std::string first_log, first_trace;
    for (const auto source : {unit::Source::Replay, unit::Source::Exec})
      for (const auto mode : {unit::Mode::Plain, unit::Mode::Batch, unit::Mode::Cycle, unit::Mode::Pins}) {
        SCOPED_TRACE(c.name + ", mode " + std::to_string(static_cast<int>(mode)));
        Timeline timeline(150, 800);
        VectorFeed feed(world.blocks());
        unit::run(config_of(c), {world.image(), world.tester(), feed},
                  {.mode = mode, .source = source, .timeline = &timeline});
        const std::string log = sim::kanata_log(timeline), trace = sim::perfetto_trace(timeline);
        if (first_log.empty()) {
          first_log = log;
          first_trace = trace;
        }
        EXPECT_TRUE(log == first_log);
        EXPECT_TRUE(trace == first_trace);
      }
  }
}

TEST(KanataLog, leads_every_ray_through_legal_stages_from_its_set_up_to_its_result) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const auto [result, timeline] = watch(c);
    const KanataLog log = read_kanata(sim::kanata_log(timeline));
    EXPECT_EQ(log.last_cycle, result.cycles);
    std::map<std::string, std::uint64_t> cycles;
    std::map<std::uint64_t, std::string> at;  // the stage that each ray was in last
    std::map<std::uint64_t, std::size_t> last_op;
    std::uint64_t flushed = 0;
    for (std::size_t id = 0; id < log.ops.size(); ++id) {
      const KanataOp& op = log.ops[id];
      SCOPED_TRACE(op.label);
      EXPECT_TRUE(op.retired || op.flushed);
      flushed += op.flushed;
      for (const KanataStage& stage : op.stages) {
        if (at[op.ray].empty())
          EXPECT_EQ(stage.name, "ray_setup");
        else
          EXPECT_TRUE(kNext.at(at[op.ray]).contains(stage.name)) << at[op.ray] << " to " << stage.name;
        cycles[stage.name] += stage.end - stage.begin;
        at[op.ray] = stage.name;
      }
      const bool follows = last_op.contains(op.ray);
      EXPECT_EQ(op.producers, follows ? std::vector{last_op[op.ray]} : std::vector<std::size_t>{});
      EXPECT_TRUE(!follows || log.ops[last_op[op.ray]].end == op.begin);
      last_op[op.ray] = id;
    }
    ASSERT_EQ(at.size(), result.rays);
    for (const auto& [ray, place] : at) EXPECT_EQ(place, "result") << ray;
    EXPECT_EQ(cycles, ray_cycles(result));
    EXPECT_EQ(flushed != 0, c.design != Design::None);
  }
}

TEST(KanataLog, has_one_operation_for_each_visit_and_says_what_it_found) {
  const Case& c = kCases[1];
  const auto [result, timeline] = watch(c);
  const KanataLog log = read_kanata(sim::kanata_log(timeline));
  std::uint64_t nodes = 0, leaves = 0, culled = 0, tested = 0, without = 0;
  for (const KanataOp& op : log.ops) {
    const auto number_before = [&](const std::string& word) {
      const auto end = op.label.find(word);
      return std::stoull(op.label.substr(op.label.rfind(' ', end - 2) + 1));
    };
    if (op.label.find("node") != std::string::npos) {
      ++nodes;
      culled += number_before(" culled");
    } else if (op.label.find("leaf") != std::string::npos) {
      ++leaves;
      tested += number_before(" tested");
    } else {
      ++without;
    }
  }
  EXPECT_EQ(nodes, result.counts.node_visits);
  EXPECT_EQ(leaves, result.counts.leaf_visits);
  EXPECT_EQ(culled, result.counts.culled);
  EXPECT_EQ(tested, result.counts.triangle_tests);
  EXPECT_GT(without, 0u) << "one in 50 rays is invalid and visits nothing";
}

TEST(KanataLog, of_a_window_leaves_open_what_goes_on_behind_it) {
  const Case& c = kCases[1];
  const Cycle last = watch(c).result.cycles / 2;
  const auto [result, timeline] = watch(c, last / 2, last);
  const KanataLog log = read_kanata(sim::kanata_log(timeline));
  EXPECT_EQ(log.first_cycle, last / 2);
  EXPECT_EQ(log.last_cycle, last + 1);
  const auto open =
      std::count_if(log.ops.begin(), log.ops.end(), [](const KanataOp& op) { return !op.retired && !op.flushed; });
  EXPECT_GT(open, 0);
  EXPECT_LE(open, config_of(c).unit.contexts);
  for (const KanataOp& op : log.ops) EXPECT_FALSE(op.stages.empty());
}

TEST(PerfettoTrace, nests_places_in_visits_in_rays_and_adds_up) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const auto [result, timeline] = watch(c);
    const auto tracks = read_perfetto(sim::perfetto_trace(timeline));
    std::map<std::string, std::uint64_t> places, busy;
    std::uint64_t latency = 0, rays = 0, counters = 0;
    for (const auto& [number, track] : tracks) {
      const std::string group = track.parent == 0 ? "" : tracks.at(track.parent).process;
      if (group == "links, entries") {
        ++counters;
        for (const auto& [at, entries] : track.counted) EXPECT_TRUE(entries >= 0 && entries <= 2) << entries;
      }
      for (const Slice& slice : track.slices) {
        const std::uint64_t cycles = slice.end - slice.begin;
        if (group == "stages") {
          EXPECT_EQ(slice.depth, 0);
          if (slice.name == "busy") busy[track.name] += cycles;
        } else if (slice.depth == 0) {
          EXPECT_TRUE(slice.name.starts_with("ray ")) << slice.name;
          latency += cycles;
          ++rays;
        } else if (slice.depth == 2) {
          places[slice.name] += cycles;
        }
      }
    }
    EXPECT_EQ(places, ray_cycles(result));
    EXPECT_EQ(latency, result.ray_latency_sum);
    EXPECT_EQ(rays, result.rays);
    EXPECT_EQ(counters, timeline.links().size());
    for (const auto& stage : result.stages) EXPECT_EQ(busy[stage.stage], stage.busy) << stage.stage;
  }
}

}  // namespace
}  // namespace ctu::test
