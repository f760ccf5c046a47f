// From the counters of the stages to the result that users see.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/pipeline/pipeline.h"
#include "model/pipeline/result.h"

namespace ctu::pipeline {

/// Collects counters under their stage's name.
class CounterList {
 public:
  void add(std::string_view name, std::string_view unit, std::string_view description, std::uint64_t value) {
    counters_.push_back({std::string(name), std::string(unit), std::string(description), value});
  }
  void add_cache(const std::string& stage, std::uint64_t lookups, std::uint64_t hits, std::uint64_t merges,
                 std::uint64_t evictions, std::uint64_t fills, std::uint64_t most_mshrs);
  /// `packets`: of packet_cull.
  template <class Counters>
  void add_packets(const Counters& packets) {
    add("packets.packets", "packets", "packets whose rays walked the top of the tree together", packets.packets);
    add("packets.rays", "rays", "rays in them", packets.rays);
    add("packets.node_visits", "nodes", "nodes that packets were asked about", packets.visits);
    add("packets.children_dropped", "children", "children that all rays of a packet miss", packets.dropped);
    add("packets.entries", "nodes", "entries, summed over packets", packets.entries);
    add("packets.all_miss", "packets", "packets without any entry: all their rays miss", packets.missing_packets);
    add("packets.node_tests_saved", "box tests",
        "box tests above the entries that rays make when they walk alone, as recorded", packets.spared);
    add("packets.most_under_way", "packets", "most packets under way at once",
        static_cast<std::uint64_t>(packets.most_under_way));
  }
  /// `trees`: of ray_queue.
  template <class Counters>
  void add_trees(const Counters& trees) {
    add("trees.local_rays", "rays", "rays that walk a tree of their light's influence area", trees.local_rays);
    add("trees.own_tests", "tests", "of boxes and primitives, of all rays in their trees, unculled, as recorded",
        trees.own_tests);
    add("trees.global_tests", "tests", "the same in the tree over the whole scene", trees.global_tests);
  }
  void add_banked(const BankedMemory::Counters& memory);
  /// The mask test's tables, together and one by one. `cached`: they lie in memory, behind table_cache.
  void add_tables(const TableBanks& tables, bool cached, const CacheConfig& cache);
  std::vector<Counter> take() { return std::move(counters_); }

 private:
  std::vector<Counter> counters_;
};

/// What of the unit a run has used at most.
struct MostUsed {
  const TableBanks* tables = nullptr;  ///< null when there is no mask test
  int stack_entries = 0, contexts = 0;
  int node_mshrs = 0, leaf_mshrs = 0;
  int table_mshrs = -1;  ///< -1: there is no table_fetch
};

/// Sentences of what this run did not need (contract 5).
std::vector<std::string> left_out(const UnitConfig& config, const UnitImage& image, const MostUsed& most);

std::vector<Cause> ray_cycles(const Contexts& contexts);

/// The result of a unit that has returned its last ray in the cycle before `end`.
template <class Source, class Wiring>
UnitResult make_result(UnitState<Source>& state, Stages<Source, Wiring>& stages, Cycle end) {
  auto& result_queue = Wiring::stage(stages.result_queue);
  auto& box_test = Wiring::stage(stages.box_test);
  auto& triangle_test = Wiring::stage(stages.triangle_test);
  auto& stack = Wiring::stage(stages.traversal_stack);
  auto& memory_port = Wiring::stage(stages.memory_port);
  auto& node_fetch = Wiring::stage(stages.node_fetch);
  auto& leaf_fetch = Wiring::stage(stages.leaf_fetch);
  const auto& pushed = stack.counters();

  UnitResult result;
  result.cycles = end;
  result.rays = result_queue.rays();
  result.wrong_hits = result_queue.wrong_hits();
  result.other_visits = state.source.event_mismatches();
  result.first_wrong = result_queue.first_wrong();
  result.counts = {.rays = result.rays,
                   .node_visits = box_test.nodes(),
                   .triangle_tests = triangle_test.triangles(),
                   .leaf_visits = leaf_fetch.counters().visits,
                   .box_hits = box_test.box_hits(),
                   .dropped = pushed.dropped};
  for_each_stage(stages, [&](auto& stage) { result.stages.push_back(stage.account.close()); });

  CounterList counters;
  counters.add("contexts.occupied_cycles", "context cycles", "sum over cycles of occupied contexts",
               state.contexts.occupied_cycles());
  counters.add("contexts.most_occupied", "contexts", "most contexts occupied at once",
               static_cast<std::uint64_t>(state.contexts.most_occupied()));
  if (state.image.trees() > 1) counters.add_trees(Wiring::stage(stages.ray_queue).counters());
  if (stages.packet_cull) counters.add_packets(Wiring::stage(*stages.packet_cull).counters());
  counters.add("scheduler.most_ready", "rays", "most rays ready at once", Wiring::stage(stages.scheduler).most_ready());
  const auto add_fetch = [&](const auto& fetch) {
    const auto& c = fetch.counters();
    counters.add_cache(std::string(fetch.account.stage()), c.lookups, c.hits, c.merges, fetch.tags().evictions(),
                       c.fills, static_cast<std::uint64_t>(fetch.mshrs().most_in_use()));
    counters.add(std::string(fetch.account.stage()) + ".bytes", "bytes", "bytes that visits asked for", c.bytes);
  };
  add_fetch(node_fetch);
  add_fetch(leaf_fetch);
  counters.add("memory.node_requests", "lines", "lines read for nodes", memory_port.requests_of(Client::NodeFetch));
  counters.add("memory.leaf_requests", "lines", "lines read for leaves", memory_port.requests_of(Client::LeafFetch));
  counters.add("memory.stack_requests", "lines", "lines written and read for spilled stack entries",
               memory_port.requests_of(Client::Stack));
  if (memory_port.banked() != nullptr) counters.add_banked(memory_port.banked()->counters());
  MostUsed most{.stack_entries = pushed.deepest,
                .contexts = state.contexts.most_occupied(),
                .node_mshrs = node_fetch.mshrs().most_in_use(),
                .leaf_mshrs = leaf_fetch.mshrs().most_in_use()};
  if (stages.table_fetch) {
    auto& table_fetch = Wiring::stage(*stages.table_fetch);
    add_fetch(table_fetch);
    counters.add("memory.table_requests", "lines", "lines read for table rows",
                 memory_port.requests_of(Client::TableFetch));
    most.table_mshrs = table_fetch.mshrs().most_in_use();
  }
  if (stages.primitive_cull) {
    const auto& culled = Wiring::stage(*stages.primitive_cull).counters();
    result.counts.boxed_out = culled.culled;
    counters.add("primitive_cull.boxes", "boxes", "boxes of primitives held against a ray's", culled.boxes);
    counters.add("primitive_cull.culled", "primitives", "primitives whose box was not met, not tested", culled.culled);
    counters.add("primitive_cull.emptied", "leaves", "leaves without a primitive left to test", culled.emptied);
  }
  if (stages.sphere_test)
    counters.add("sphere_test.spheres", "spheres", "spheres tested", Wiring::stage(*stages.sphere_test).spheres());
  if (stages.mask_test) {
    auto& mask_test = Wiring::stage(*stages.mask_test);
    auto& cell_locate = Wiring::stage(*stages.cell_locate);
    result.counts.culled = mask_test.culled();
    result.counts.uncertain = mask_test.uncertain();
    most.tables = &mask_test.tables();
    counters.add("cell_locate.lanes", "lanes", "lanes located", cell_locate.lanes());
    counters.add("mask_test.lanes_unasked", "lanes", "lanes hit that passed unasked, their object masks being full",
                 cell_locate.lanes_unasked());
    counters.add_tables(mask_test.tables(), state.has_table_fetch, state.config.table_cache);
  }
  counters.add("stack.pushes", "entries", "entries pushed (the nearest child goes straight on)", pushed.pushes);
  counters.add("stack.pops", "entries", "entries popped, dropped ones included", pushed.pops);
  counters.add("stack.deepest", "entries", "most entries of one ray", static_cast<std::uint64_t>(pushed.deepest));
  counters.add("stack.spills", "batches", "batches written to memory", pushed.spills);
  counters.add("stack.refills", "batches", "batches read back from memory", pushed.refills);
  result.counters = counters.take();

  result.ray_cycles = ray_cycles(state.contexts);
  result.ray_latency_sum = state.contexts.latency_sum();
  result.left_out = left_out(state.config, state.image, most);
  result.event_log_hash = state.log.timed_hash();
  return result;
}

}  // namespace ctu::pipeline
