#include "tests/cosim/grid_configs.h"

#include <charconv>
#include <sstream>

#include "model/base/error.h"
#include "model/pipeline/parameter.h"
#include "sim/cosim/rtl_builds.h"

namespace ctu::cosim {
namespace {

void set(pipeline::UnitConfig& config, const std::string& key, const std::string& value) {
  for (const pipeline::Parameter& parameter : pipeline::parameters()) {
    if (parameter.key != key) continue;
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool is_number = error == std::errc() && end == value.data() + value.size();
    parameter.set(config, is_number ? pipeline::ParameterValue(number) : pipeline::ParameterValue(value));
    return;
  }
  throw Error(key, "is no parameter of the unit", "see `ctusim config show`");
}

}  // namespace

const std::vector<GridConfig>& grid_configs() {
  static const std::vector<GridConfig> configs = {
      // The default unit, and what time depends on around it.
      {"projection", "", 0, true},
      {"projection", "", 11, true},
      {"projection", "unit.contexts=1", 0, true},
      {"projection", "unit.contexts=2", 12},
      {"projection", "unit.contexts=7 scheduler.policy=round-robin", 13},
      {"projection", "unit.contexts=64 scheduler.policy=round-robin", 0, true},
      {"projection", "unit.contexts=64 node_cache.mshrs=1 leaf_cache.mshrs=2", 14},
      {"projection", "node_cache.bytes=128 node_cache.ways=1 leaf_cache.bytes=128 leaf_cache.ways=1", 0, true},
      {"projection", "node_cache.bytes=0 leaf_cache.bytes=0", 15, true},
      {"projection", "node_cache.bytes=4096 node_cache.ways=8 leaf_cache.bytes=2048 leaf_cache.ways=2", 16},
      {"projection", "node_cache.hit_latency=1 leaf_cache.hit_latency=20", 0},
      {"projection", "memory.model=ideal memory.latency=1 memory.interval=1", 0, true},
      {"projection", "memory.model=ideal memory.latency=200 memory.interval=7", 17},
      {"projection", "memory.model=ideal memory.latency=50 memory.interval=1 unit.contexts=5", 18},
      {"projection", "memory.channels=1 memory.queue_depth=1", 0},
      {"projection", "memory.t_rfc=0 memory.burst=40", 19},
      {"projection", "stack.entries=1 stack.push_width=1 stack.spill_batch=1", 0, true},
      {"projection", "stack.entries=3 stack.push_width=3 stack.spill_batch=2", 20},
      {"projection", "stack.entries=8 stack.push_width=2 stack.spill_batch=8 unit.contexts=64", 21, true},
      {"projection", "ray_setup.interval=9 result.interval=30 triangle_test.interval=5", 22},
      // Rays that walk one of several trees.
      {"projection", "", 0, true, {}, 5},
      {"projection", "unit.contexts=6 ray_setup.interval=4", 23, false, {}, 64},
      // Another depth of everything, and the designs of the mask test.
      {"none", "", 0, true},
      {"none", "unit.contexts=3", 30, true},
      {"none", "memory.model=ideal memory.latency=3 memory.interval=1 stack.entries=2 stack.spill_batch=1", 31},
      {"mask-lut", "", 0, true},
      {"mask-lut", "node_cache.bytes=1024 node_cache.ways=2", 32, true},
      {"mask-lut", "unit.contexts=20 memory.model=ideal memory.latency=20 memory.interval=2", 33},
      {"mask-lut-256", "", 0},
      {"mask-lut-256", "unit.contexts=16 stack.entries=2 stack.spill_batch=2", 34},
      {"projection-r6", "", 0},
      {"projection-r6", "unit.contexts=24", 35},
      {"projection-r6", "node_cache.bytes=0 memory.model=ideal memory.latency=90 memory.interval=1", 36},
      {"bit-table", "", 0, true},
      {"bit-table", "unit.contexts=5 node_cache.bytes=512 node_cache.ways=4", 37},
      {"bit-table", "memory.model=ideal memory.latency=9 memory.interval=3", 38},
      {"dedup", "", 0, true},
      {"dedup", "unit.contexts=9 scheduler.policy=round-robin", 39, true},
      {"dedup", "memory.model=ideal memory.latency=40 memory.interval=1", 40},
      {"dedup-cached",
       "unit.contexts=8 node_cache.bytes=1024 leaf_cache.bytes=1024 table_cache.bytes=1024 stack.spill_batch=4", 0,
       true},
      {"dedup-cached",
       "unit.contexts=8 node_cache.bytes=2048 leaf_cache.bytes=2048 table_cache.bytes=32 table_cache.ways=1 "
       "table_cache.mshrs=2 stack.entries=3 stack.spill_batch=2 memory.model=ideal memory.latency=60 memory.interval=2",
       45, true},
      {"dedup-cached",
       "unit.contexts=3 node_cache.bytes=512 leaf_cache.bytes=512 table_cache.bytes=256 table_cache.ways=2 "
       "table_cache.mshrs=1 table_cache.hit_latency=7 stack.spill_batch=4",
       46},
      {"dedup-cached",
       "unit.contexts=7 node_cache.bytes=1024 leaf_cache.bytes=1024 table_cache.bytes=128 table_cache.ways=4 "
       "table_cache.hit_latency=1 stack.spill_batch=1 memory.model=ideal memory.latency=1 memory.interval=1",
       0},
      {"projection-cached",
       "unit.contexts=8 node_cache.bytes=2048 leaf_cache.bytes=2048 table_cache.bytes=1024 table_cache.ways=2", 0},
      {"projection-cached",
       "unit.contexts=5 node_cache.bytes=2048 leaf_cache.bytes=2048 table_cache.bytes=64 table_cache.ways=1 "
       "table_cache.mshrs=1 stack.entries=2 stack.spill_batch=2 memory.model=ideal memory.latency=30 memory.interval=1",
       53},
      {"bit-table-cached",
       "unit.contexts=4 node_cache.bytes=1024 node_cache.ways=2 leaf_cache.bytes=1024 leaf_cache.ways=2 "
       "table_cache.bytes=1024 table_cache.ways=2",
       0},
      {"bit-table-cached",
       "unit.contexts=3 node_cache.bytes=1024 node_cache.ways=1 leaf_cache.bytes=1024 leaf_cache.ways=2 "
       "table_cache.bytes=256 table_cache.ways=1 table_cache.mshrs=2 table_cache.hit_latency=5",
       54},
      {"comparators", "", 0, true},
      {"comparators", "unit.contexts=13 node_cache.bytes=256 node_cache.ways=1", 41},
      {"comparators-r6", "", 0},
      {"comparators-r6", "unit.contexts=18", 42},
      {"projection-r-ray-8", "", 43},
      {"projection-r-ray-8", "unit.contexts=6 scheduler.policy=round-robin", 44},
      // Boxes of reduced precision.
      {"boxes-8", "", 0},
      {"boxes-8", "unit.contexts=64 scheduler.policy=round-robin", 50},
      {"boxes-8", "unit.contexts=3 node_cache.bytes=256 node_cache.ways=1", 51},
      {"boxes-16", "", 0},
      {"boxes-16", "memory.model=ideal memory.latency=5 memory.interval=1 unit.contexts=11", 52},
      // What leaves may hold.
      {"ray-boxes", "unit.contexts=8 node_cache.bytes=8192 leaf_cache.bytes=8192", 0, true},
      {"ray-boxes",
       "unit.contexts=5 node_cache.bytes=4096 leaf_cache.bytes=512 leaf_cache.ways=1 stack.entries=2 "
       "stack.spill_batch=2",
       60, true},
      {"ray-boxes",
       "unit.contexts=7 node_cache.bytes=8192 leaf_cache.bytes=8192 stack.entries=16 stack.spill_batch=8 "
       "triangle_test.interval=4 memory.model=ideal memory.latency=30 memory.interval=1",
       61},
      {"ray-boxes-spheres", "unit.contexts=16", 0, true},
      {"ray-boxes-spheres", "unit.contexts=9 stack.entries=1 stack.push_width=1 stack.spill_batch=1", 62, true},
      {"ray-boxes-spheres", "memory.model=ideal memory.latency=2 memory.interval=1 unit.contexts=12", 63},
      {"spheres", "unit.contexts=8", 0},
      {"spheres", "unit.contexts=3 triangle_test.interval=3 leaf_cache.bytes=0", 64},
      // Rays in packets: their size and the most entries they may have, above that what time depends on.
      {"packets", "", 0, true, {16, 8}},
      {"packets",
       "unit.contexts=9 packet_cull.packets=2 node_cache.bytes=256 node_cache.ways=1 leaf_cache.bytes=256 "
       "leaf_cache.ways=1 stack.entries=2 stack.push_width=1 stack.spill_batch=2",
       70,
       true,
       {4, 8}},
      {"packets",
       "unit.contexts=64 node_cache.bytes=1024 packet_cull.packets=1 scheduler.policy=round-robin",
       71,
       false,
       {64, 16}},
      {"packets",
       "unit.contexts=64 packet_cull.interval=9 stack.entries=1 stack.push_width=2 stack.spill_batch=1 "
       "memory.model=ideal memory.latency=1 memory.interval=1",
       0,
       false,
       {64, 8}},
      {"packets", "unit.contexts=16 node_cache.bytes=0 leaf_cache.bytes=0 result.interval=20", 72, false, {16, 1}},
      {"packets", "unit.contexts=20 packet_cull.packets=3", 74, true, {8, 4}, 3},
      {"packets-ray-boxes", "unit.contexts=16 node_cache.bytes=4096 leaf_cache.bytes=2048", 0, false, {4, 5}},
      {"packets-ray-boxes",
       "unit.contexts=16 packet_cull.packets=2 packet_cull.interval=2 node_cache.bytes=128 node_cache.ways=1 "
       "leaf_cache.bytes=128 leaf_cache.ways=1 stack.entries=3 stack.spill_batch=2 memory.model=ideal "
       "memory.latency=30 memory.interval=1",
       73,
       false,
       {16, 3}},
  };
  return configs;
}

pipeline::UnitConfig unit_config(const RtlParameters& build, const std::string& settings) {
  pipeline::UnitConfig config = config_of(build);
  std::istringstream words(settings);
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    set(config, word.substr(0, equals), equals == std::string::npos ? "" : word.substr(equals + 1));
  }
  return config;
}

cull::MaskOptions mask_options(const RtlParameters& build) {
  cull::MaskOptions options;
  options.resolution = build.resolution;
  options.ray_resolution = build.ray_resolution;
  options.entries = build.entries;
  return options;
}

}  // namespace ctu::cosim
