#include "sim/check/unit_timing.h"

#include <algorithm>

namespace ctu::sim::check {
namespace {

void draw_cache(CaseRandom& random, const pipeline::MemoryConfig& memory, pipeline::CacheConfig& cache) {
  constexpr int kLines[] = {0, 1, 8, 64, 512};
  constexpr int kWays[] = {1, 2, 4};
  constexpr int kMshrs[] = {1, 4, 16};
  const int lines = random.one_of(kLines);
  cache.bytes = lines * memory.line_bytes;
  cache.ways = std::min(random.one_of(kWays), std::max(lines, 1));
  cache.mshrs = random.one_of(kMshrs);
}

void draw_stack(CaseRandom& random, pipeline::UnitConfig& config) {
  constexpr int kEntries[] = {1, 2, 4, 16};
  config.stack.entries = random.one_of(kEntries);
  config.stack.push_width = random.pick(1, 3);
  config.stack.spill_batch = std::min(config.stack.entries, 8);
}

}  // namespace

void draw_timing(CaseRandom& random, bool with_tables, pipeline::UnitConfig& config) {
  constexpr int kContexts[] = {1, 4, 32, 64};
  constexpr int kLatencies[] = {1, 20, 180};
  config.unit.contexts = random.one_of(kContexts);
  config.scheduler.policy =
      random.chance(0.5) ? pipeline::SchedulerPolicy::Oldest : pipeline::SchedulerPolicy::RoundRobin;
  config.memory.model = random.chance(0.5) ? pipeline::MemoryModel::Ideal : pipeline::MemoryModel::Banked;
  config.memory.latency = random.one_of(kLatencies);
  draw_cache(random, config.memory, config.node_cache);
  draw_cache(random, config.memory, config.leaf_cache);
  if (with_tables && random.chance(0.25)) config.table_cache.bytes = 32 * config.memory.line_bytes;
  draw_stack(random, config);
}

void draw_short_timing(CaseRandom& random, pipeline::UnitConfig& config) {
  constexpr int kContexts[] = {8, 32, 32};
  config.unit.contexts = random.one_of(kContexts);
  config.memory.model = pipeline::MemoryModel::Ideal;
  config.memory.latency = random.pick(1, 8);
  config.memory.interval = 1;
  if (random.chance(0.25)) draw_stack(random, config);
}

}  // namespace ctu::sim::check
