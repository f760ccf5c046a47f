#include "model/pipeline/unit_config.h"

#include <bit>
#include <utility>

#include "model/base/error.h"
#include "model/pipeline/parameter.h"

namespace ctu::pipeline {
namespace {

/// Bounds of an integer parameter.
struct Range {
  std::int64_t minimum, maximum;
  bool power_of_two = false;
};

/// `field` gives the member of a configuration, constant or not.
template <class Field>
Parameter integer(std::string key, std::string unit, Range range, Field field, std::string description) {
  Parameter parameter{std::move(key),
                      std::move(unit),
                      std::move(description),
                      std::int64_t{0},
                      range.minimum,
                      range.maximum,
                      range.power_of_two,
                      {},
                      {},
                      {},
                      false};
  const UnitConfig defaults;
  parameter.default_value = static_cast<std::int64_t>(field(defaults));
  parameter.get = [field](const UnitConfig& config) -> ParameterValue {
    return static_cast<std::int64_t>(field(config));
  };
  parameter.set = [field](UnitConfig& config, const ParameterValue& value) {
    auto& member = field(config);
    member = static_cast<std::remove_reference_t<decltype(member)>>(std::get<std::int64_t>(value));
  };
  return parameter;
}

/// A choice among names: the member's value is the position of its name in `names`.
template <class Value, class Field>
Parameter choice(std::string key, std::vector<std::pair<std::string, Value>> names, Field field,
                 std::string description) {
  Parameter parameter;
  parameter.key = std::move(key);
  parameter.description = std::move(description);
  for (const auto& [name, value] : names) parameter.choices.push_back(name);
  parameter.get = [field, names, key = parameter.key](const UnitConfig& config) -> ParameterValue {
    for (const auto& [name, value] : names)
      if (value == field(config)) return name;
    throw Error(key, "the value has no name", "choose one of the listed values");
  };
  parameter.set = [field, names, key = parameter.key](UnitConfig& config, const ParameterValue& value) {
    const std::string& wanted = std::get<std::string>(value);
    for (const auto& [name, known] : names)
      if (name == wanted) {
        field(config) = known;
        return;
      }
    throw Error(key, "\"" + wanted + "\" is not one of the choices", "see `config show` for the choices");
  };
  parameter.default_value = parameter.get(UnitConfig{});
  return parameter;
}

constexpr std::int64_t kMaxLatency = 100;  // of a pipelined stage, cycles

using Parameters = std::vector<Parameter>;

void add_front_end(Parameters& list) {
  list.push_back(integer(
      "unit.contexts", "rays", {1, 256}, [](auto& c) -> auto& { return c.unit.contexts; },
      "Ray contexts, one ray each. 32 hides the 30-cycle pipeline at one visit a cycle; published units "
      "hold 32 to 256 rays."));
  list.push_back(integer(
      "unit.batch_cycles", "cycles", {1, 1000000}, [](auto& c) -> auto& { return c.unit.batch_cycles; },
      "Cycles per SystemC activation in batch mode. Never changes a result: the memory is inside the "
      "batch. From 16 on the kernel's cost is hidden (measured)."));
  list.push_back(integer(
      "ray_setup.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.ray_setup.latency; },
      "Reciprocal bounds and shear: select 1, divide 16, directed neighbour 1, write 2."));
  list.push_back(integer(
      "ray_setup.interval", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.ray_setup.interval; },
      "Cycles between rays: six divisions on two pipelined dividers."));
  const auto add_packets = [&](const char* key, const char* unit, Range range, auto field, const char* text) {
    list.push_back(integer(std::string("packet_cull.") + key, unit, range, field, text));
    list.back().new_since_hashes = true;
  };
  add_packets(
      "packets", "packets", {1, 64}, [](auto& c) -> auto& { return c.packet_cull.packets; },
      "Packets under way at once, the one that rays are joining included. Not there where rays do not travel in "
      "packets, as the rest of packet_cull.");
  add_packets(
      "latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.packet_cull.latency; },
      "A packet against the children of a node: subtract 4, multiply 4, compare tree 3, search 1.");
  add_packets(
      "interval", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.packet_cull.interval; },
      "Cycles between nodes: the four children one after the other on the arithmetic of one lane.");
  list.push_back(choice<SchedulerPolicy>(
      "scheduler.policy", {{"oldest", SchedulerPolicy::Oldest}, {"round-robin", SchedulerPolicy::RoundRobin}},
      [](auto& c) -> auto& { return c.scheduler.policy; },
      "Which ready ray is issued: the one that has waited longest, or the next by number."));
}

template <class Cache>
void add_cache(Parameters& list, const std::string& name, const std::string& what, const std::string& about_bytes,
               Cache cache) {
  list.push_back(integer(
      name + ".bytes", "bytes", {0, 1 << 26}, [cache](auto& c) -> auto& { return cache(c).bytes; }, about_bytes));
  list.push_back(integer(
      name + ".ways", "ways", {1, 16}, [cache](auto& c) -> auto& { return cache(c).ways; },
      "Lines that one set holds; least recently used goes first."));
  list.push_back(integer(
      name + ".hit_latency", "cycles", {1, 100}, [cache](auto& c) -> auto& { return cache(c).hit_latency; },
      "From the lookup of the last line to its data: tag, data, align."));
  list.push_back(integer(
      name + ".ports", "lines", {1, 8}, [cache](auto& c) -> auto& { return cache(c).ports; },
      "Lines of one " + what + " looked up in a cycle."));
  list.push_back(integer(
      name + ".mshrs", "registers", {1, 64}, [cache](auto& c) -> auto& { return cache(c).mshrs; },
      "Lines under way from memory at once; published models use 8 to 64."));
}

void add_memory(Parameters& list) {
  const auto add = [&](const char* key, const char* unit, Range range, auto field, const char* text) {
    list.push_back(integer(std::string("memory.") + key, unit, range, field, text));
  };
  list.push_back(choice<MemoryModel>(
      "memory.model", {{"ideal", MemoryModel::Ideal}, {"banked", MemoryModel::Banked}},
      [](auto& c) -> auto& { return c.memory.model; },
      "ideal: fixed latency and bandwidth. banked: channels, banks, open rows and "
      "refresh; a fixed latency understates what a smaller cache costs (measured: by 14 "
      "points and more)."));
  add(
      "line_bytes", "bytes", {32, 512, true}, [](auto& c) -> auto& { return c.memory.line_bytes; },
      "Line of all caches and of every request to memory. 128 as in published GPU models.");
  add(
      "latency", "cycles", {1, 4096}, [](auto& c) -> auto& { return c.memory.latency; },
      "ideal: from request to answer. Published round trips are 60 to 400.");
  add(
      "interval", "cycles", {1, 4096}, [](auto& c) -> auto& { return c.memory.interval; },
      "ideal: cycles between lines: 128 bytes each 4 cycles are 32 bytes a cycle.");
  add(
      "channels", "channels", {1, 16, true}, [](auto& c) -> auto& { return c.memory.channels; },
      "banked: channels with a data bus each; neighbouring lines alternate.");
  add(
      "banks", "banks", {1, 64, true}, [](auto& c) -> auto& { return c.memory.banks; }, "banked: banks of a channel.");
  add(
      "row_bytes", "bytes", {512, 65536, true}, [](auto& c) -> auto& { return c.memory.row_bytes; },
      "banked: bytes of an open row of one channel.");
  add(
      "front_latency", "cycles", {0, 4096}, [](auto& c) -> auto& { return c.memory.front_latency; },
      "banked: way to the memory controller and back, through what lies between, an L2 included.");
  add(
      "queue_depth", "requests", {1, 256}, [](auto& c) -> auto& { return c.memory.queue_depth; },
      "banked: requests that a channel chooses among.");
  add(
      "t_rcd", "cycles", {1, 1000}, [](auto& c) -> auto& { return c.memory.t_rcd; }, "banked: activate to access.");
  add(
      "t_rp", "cycles", {1, 1000}, [](auto& c) -> auto& { return c.memory.t_rp; }, "banked: precharge to activate.");
  add(
      "t_cl", "cycles", {1, 1000}, [](auto& c) -> auto& { return c.memory.t_cl; }, "banked: access to data.");
  add(
      "t_ras", "cycles", {1, 1000}, [](auto& c) -> auto& { return c.memory.t_ras; }, "banked: activate to precharge.");
  add(
      "burst", "cycles", {1, 256}, [](auto& c) -> auto& { return c.memory.burst; },
      "banked: cycles of a line on the data bus: 128 bytes in 8 cycles are 16 bytes a cycle and channel.");
  add(
      "t_rfc", "cycles", {0, 10000}, [](auto& c) -> auto& { return c.memory.t_rfc; },
      "banked: length of a refresh; 0: no refresh.");
  add(
      "t_refi", "cycles", {100, 1000000}, [](auto& c) -> auto& { return c.memory.t_refi; },
      "banked: cycles between refreshes.");
  add(
      "age_cap", "cycles", {1, 1000000}, [](auto& c) -> auto& { return c.memory.age_cap; },
      "banked: a request older than this goes first, whatever its row.");
}

void add_node_path(Parameters& list) {
  list.push_back(integer(
      "box_decode.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.box_decode.latency; },
      "Boxes of reduced precision: steps to binary32 1, directed add of the origin 4. In front of the box test; not "
      "there where boxes are binary32."));
  list.back().new_since_hashes = true;
  list.push_back(integer(
      "box_test.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.box_test.latency; },
      "Subtract 4, multiply 4, compare tree 3."));
  list.push_back(integer(
      "cell_locate.units", "lanes", {1, 4}, [](auto& c) -> auto& { return c.cell_locate.units; },
      "Lanes located at once. One unit shared by the few lanes hit costs +15 % on the box test, four cost "
      "+58 % (trial synthesis)."));
  list.push_back(integer(
      "cell_locate.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.cell_locate.latency; },
      "Bisection on [t0, t1] for R = 4, adders and comparisons (trial synthesis: 10)."));
  list.push_back(integer(
      "comparators.units", "lanes", {1, 4}, [](auto& c) -> auto& { return c.comparators.units; },
      "Design comparators: lanes compared at once."));
  list.push_back(integer(
      "comparators.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.comparators.latency; },
      "Design comparators: subtract 4, add 4, maximum and minimum 2, compare and AND 2."));
  list.push_back(choice<cull::Design>(
      "mask_test.design",
      {{"none", cull::Design::None},
       {"mask-lut", cull::Design::MaskLut},
       {"bit-table", cull::Design::BitTable},
       {"dedup", cull::Design::Dedup},
       {"projection", cull::Design::Projection},
       {"comparators", cull::Design::Comparators}},
      [](auto& c) -> auto& { return c.mask_test.design; },
      "How the unit finds the cells a ray touches. projection gives the masks of mask-lut "
      "from 1/21 to 1/1000 of the memory. bit-table needs compressed object masks."));
  list.push_back(choice<cull::TableRows>(
      "mask_test.rows",
      {{"all", cull::TableRows::All}, {"folded", cull::TableRows::Folded}, {"reachable", cull::TableRows::Reachable}},
      [](auto& c) -> auto& { return c.mask_test.rows; },
      "Rows that the tables have. folded: one for a key and its reverse, and for mirrored keys where a row can be "
      "mirrored. reachable: of those, only rows for rays from outside the box; refuses rays that begin inside one."));
  list.push_back(integer(
      "mask_test.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.mask_test.latency; },
      "Table read 1, expand and AND 1 (trial synthesis: 2)."));
  list.push_back(integer(
      "mask_test.second_latency", "cycles", {1, kMaxLatency},
      [](auto& c) -> auto& { return c.mask_test.second_latency; },
      "Design dedup: the read with the id, on top of mask_test.latency: a table read, 1 as for the first."));
  list.push_back(integer(
      "mask_test.banks", "banks", {1, 64, true}, [](auto& c) -> auto& { return c.mask_test.banks; },
      "Banks of each resident table; row r lies in bank r mod banks."));
  list.push_back(integer(
      "mask_test.ports", "reads", {1, 4}, [](auto& c) -> auto& { return c.mask_test.ports; },
      "Reads that a bank answers in a cycle."));
  list.push_back(integer(
      "mask_test.projection_tables", "tables", {1, 3}, [](auto& c) -> auto& { return c.mask_test.projection_tables; },
      "Design projection: 3, a table for each pair of axes, or 1, read three times a lane."));
  add_cache(
      list, "table_cache", "node's table rows",
      "Cache of table rows, when the mask test's tables lie in memory; 0: the tables are resident, on chip as a "
      "whole, as all designs allow at R = R_ray = 4.",
      [](auto& c) -> auto& { return c.table_cache; });
  list.push_back(integer(
      "child_sort.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.child_sort.latency; },
      "Five comparators in three rows."));
  list.push_back(integer(
      "stack.entries", "entries", {1, 64}, [](auto& c) -> auto& { return c.stack.entries; },
      "Stack entries of a context on chip, 8 bytes each; more are spilled to memory, never dropped."));
  list.push_back(integer(
      "stack.push_width", "entries", {1, 3}, [](auto& c) -> auto& { return c.stack.push_width; },
      "Entries pushed in a cycle: 2 banks."));
  list.push_back(integer(
      "stack.spill_batch", "entries", {1, 64, true}, [](auto& c) -> auto& { return c.stack.spill_batch; },
      "Entries written or read back at once; at most a line's worth."));
}

void add_leaf_path(Parameters& list) {
  list.push_back(integer(
      "primitive_cull.units", "boxes", {1, 4}, [](auto& c) -> auto& { return c.primitive_cull.units; },
      "Images with primitive boxes: boxes held against the ray's in a cycle."));
  list.back().new_since_hashes = true;
  list.push_back(integer(
      "primitive_cull.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.primitive_cull.latency; },
      "Images with primitive boxes: end of the stay 1, multiply 4, add 4, compare 1."));
  list.back().new_since_hashes = true;
  list.push_back(integer(
      "triangle_test.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.triangle_test.latency; },
      "Translate 4, shear 8, edge functions 8, determinant 8, divide 16, range 1."));
  list.push_back(integer(
      "triangle_test.interval", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.triangle_test.interval; },
      "Cycles between triangles."));
  list.push_back(integer(
      "sphere_test.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.sphere_test.latency; },
      "Images with spheres: from the centre 4, dot product 12, divide 16, nearest point 8, its dot product 12, under "
      "the "
      "root 4, divide 16, root 12, ends of the chord 4, range 1."));
  list.back().new_since_hashes = true;
  list.push_back(integer(
      "hit_update.latency", "cycles", {1, kMaxLatency}, [](auto& c) -> auto& { return c.hit_update.latency; },
      "Compare 1, write 1."));
  list.push_back(integer(
      "result.interval", "cycles", {1, 1000}, [](auto& c) -> auto& { return c.result.interval; },
      "Cycles between returned rays."));
  list.push_back(integer(
      "watchdog.cycles", "cycles", {100, 1000000000}, [](auto& c) -> auto& { return c.watchdog.cycles; },
      "When nothing moves for so long, the run ends with a report of every link and stage."));
}

[[noreturn]] void reject(const std::string& keys, const std::string& what, const std::string& remedy) {
  throw Error(keys, what, remedy);
}

void check_ranges(const UnitConfig& config) {
  for (const Parameter& parameter : parameters()) {
    const ParameterValue value = parameter.get(config);
    if (!std::holds_alternative<std::int64_t>(value)) continue;
    const std::int64_t number = std::get<std::int64_t>(value);
    if (number < parameter.minimum || number > parameter.maximum)
      reject(parameter.key, std::to_string(number) + " is out of range",
             "choose from " + std::to_string(parameter.minimum) + " to " + std::to_string(parameter.maximum));
    if (parameter.power_of_two && !std::has_single_bit(static_cast<std::uint64_t>(number)))
      reject(parameter.key, std::to_string(number) + " is not a power of two", "choose a power of two");
  }
}

void check_cache(const std::string& name, const CacheConfig& cache, int line_bytes) {
  if (cache.bytes == 0) return;
  const std::string keys = name + ".bytes, " + name + ".ways, memory.line_bytes";
  const std::int64_t set_bytes = static_cast<std::int64_t>(cache.ways) * line_bytes;
  if (cache.bytes % set_bytes != 0 || !std::has_single_bit(static_cast<std::uint64_t>(cache.bytes / set_bytes)))
    reject(keys,
           std::to_string(cache.bytes) + " bytes are not a power of two of sets of " + std::to_string(cache.ways) +
               " lines of " + std::to_string(line_bytes) + " bytes",
           "choose bytes = ways * line_bytes * a power of two");
}

}  // namespace

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> list = [] {
    Parameters all;
    add_front_end(all);
    const auto l1_of = [](const char* what) {
      return "Cache of " + std::string(what) +
             "; 0: none, every line comes from memory. 64 KiB is an L1 of published ray-tracing models.";
    };
    add_cache(
        all, "node_cache", "node", l1_of("node"), [](auto& c) -> auto& { return c.node_cache; });
    add_cache(
        all, "leaf_cache", "leaf", l1_of("leaf"), [](auto& c) -> auto& { return c.leaf_cache; });
    add_memory(all);
    add_node_path(all);
    add_leaf_path(all);
    return all;
  }();
  return list;
}

void check_consistency(const UnitConfig& config) {
  check_ranges(config);
  check_cache("node_cache", config.node_cache, config.memory.line_bytes);
  check_cache("leaf_cache", config.leaf_cache, config.memory.line_bytes);
  check_cache("table_cache", config.table_cache, config.memory.line_bytes);
  if (config.memory.row_bytes < config.memory.line_bytes)
    reject("memory.row_bytes, memory.line_bytes", "a row is smaller than a line", "choose larger rows");
  if (config.memory.t_rfc >= config.memory.t_refi)
    reject("memory.t_rfc, memory.t_refi", "a refresh lasts longer than the time between two", "choose t_rfc < t_refi");
  if (config.stack.spill_batch > config.stack.entries)
    reject("stack.spill_batch, stack.entries", "a batch holds more entries than the stack", "choose a smaller batch");
  if (config.stack.spill_batch * 8 > config.memory.line_bytes)
    reject("stack.spill_batch, memory.line_bytes", "a batch of 8-byte entries is larger than a line",
           "choose a smaller batch");
  if (config.mask_test.projection_tables == 2)
    reject("mask_test.projection_tables", "two tables cannot serve three pairs of axes", "choose 1 or 3");
  if (config.mask_test.design == cull::Design::Ideal)
    reject("mask_test.design", "ideal culling exists in software only", "choose another design");
  const std::int64_t longest = config.memory.model == MemoryModel::Ideal
                                   ? config.memory.latency + config.memory.interval
                                   : config.memory.front_latency + config.memory.t_rfc + config.memory.t_rp +
                                         config.memory.t_rcd + config.memory.t_cl + config.memory.t_ras +
                                         config.memory.burst;
  if (config.watchdog.cycles <= longest)
    reject("watchdog.cycles", "memory alone may answer later than the watchdog waits",
           "choose more than " + std::to_string(longest));
}

}  // namespace ctu::pipeline
