// ctu_mutants FOLDER: every broken build of the RTL unit (sim/cosim/mutants.cmake) in lock step with the model until
// they differ. 1 when one is not found, or when what is named is not where it is broken.
#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "sim/cosim/lock_step.h"
#include "sim/cosim/rtl_builds.h"
#include "tests/cosim/grid_configs.h"
#include "tests/cosim/grid_traces.h"

namespace ctu::cosim {
namespace {

/// The stage or the links that the first difference must be at: those of the module that is broken.
const std::map<std::string, std::vector<std::string>>& broken_places() {
  static const std::map<std::string, std::vector<std::string>> places = {
      {"wide-ties-away", {"triangle_to_hit"}},
      {"unmirrored-planes", {"box_to_sort"}},
      {"open-slab", {"box_to_sort"}},
      {"pipe-entered-while-frozen",
       {"ray_queue", "box_test", "child_sort", "triangle_test", "hit_update", "node_to_box", "leaf_to_triangle",
        "triangle_to_hit", "box_to_sort"}},
      {"result-interval-late", {"result_queue", "stack_to_result", "ray_to_result", "result_to_ray"}},
      {"fetch-reads-uncounted", {"node_fetch", "leaf_fetch", "node_to_box", "leaf_to_triangle"}},
      {"fetch-turn-stays", {"node_to_box", "leaf_to_triangle"}},
      {"scheduler-nodes-first", {"scheduler", "scheduler_to_node", "scheduler_to_leaf"}},
      {"no-turns", {"sort_to_stack", "hit_to_stack", "memory_to_stack"}},
      {"nearest-first", {"stack_to_scheduler"}},
      {"port-turn-stays", {"node_to_memory", "leaf_to_memory", "stack_to_memory"}},
      {"hit-later-wins", {"hit_update", "hit_to_stack", "stack_to_scheduler", "unit", "hit"}},
      {"sort-lane-ties", {"sort_to_stack"}},
      {"packet-doubts", {"packet_to_scheduler", "packet_to_stack", "packet_cull"}},
      {"packet-origins-swapped", {"packet_to_scheduler", "packet_to_stack", "packet_cull"}},
  };
  return places;
}

/// What the build is for.
reference::PacketPlan packets_for(const RtlParameters& build) {
  return build.packets == 0 ? reference::PacketPlan{} : reference::PacketPlan{4, build.packet_entries};
}

/// What the twins first differ in, over traces, settings and refusals; or a wrong hit.
std::optional<Difference> find(RtlUnit& unit) {
  constexpr const char* kSettings[] = {
      "unit.contexts=8 node_cache.bytes=2048 node_cache.ways=2 node_cache.mshrs=4 leaf_cache.bytes=2048 "
      "leaf_cache.ways=2 leaf_cache.mshrs=4 stack.entries=4 stack.spill_batch=2 result.interval=3"};
  for (const char* settings : kSettings)
    for (const std::uint64_t stalls : {0, 5, 6})
      for (const char* trace : {"hair", "interior", "hostile"}) {
        const auto world = make_grid_world(trace, unit.parameters(), 150, packets_for(unit.parameters()));
        test::VectorFeed model_feed(world->blocks(), world->packets()), rtl_feed(world->blocks(), world->packets());
        LockStepOptions options;
        options.stall_seed = stalls;
        const LockStepResult result =
            run_lock_step(unit, unit_config(unit.parameters(), settings), {world->image(), world->tester(), model_feed},
                          {world->image(), world->tester(), rtl_feed}, options);
        if (result.difference) return result.difference;
        if (result.rtl_wrong_hits != 0)
          return Difference{
              result.cycles, "hit", "bits", "expected", fmt::format("{} wrong", result.rtl_wrong_hits), {}, 0};
      }
  return std::nullopt;
}

int run(const std::string& folder) {
  int missed = 0;
  for (const auto& [name, places] : broken_places()) {
    const auto unit = load_rtl_unit(folder + "/" + name + ".so");
    const std::optional<Difference> difference = find(*unit);
    const bool named = difference && std::find(places.begin(), places.end(), difference->module) != places.end();
    missed += !named;
    fmt::print("{:<28} {}  {}\n", name,
               !difference ? "NOT FOUND"
               : named     ? "found"
                           : "NAMED ELSEWHERE",
               difference ? to_string(*difference) : "");
  }
  fmt::print("{} broken units, {} not found or named elsewhere\n", broken_places().size(), missed);
  return missed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace ctu::cosim

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "ctu_mutants FOLDER\n");
    return 2;
  }
  try {
    return ctu::cosim::run(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
