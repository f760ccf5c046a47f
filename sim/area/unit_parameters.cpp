#include "sim/area/unit_parameters.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <optional>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "model/accel/forest.h"
#include "model/accel/image.h"
#include "model/base/error.h"
#include "model/cull/on_chip_tables.h"
#include "model/reference/entry_list.h"

namespace ctu::area {
namespace {

using cull::Design;

constexpr int kMinLoadBits = 32;

int bits_for(int count) { return count <= 2 ? 1 : std::bit_width(static_cast<unsigned>(count - 1)); }

int sets_of(const pipeline::CacheConfig& cache, int line_bytes) {
  return cache.bytes == 0 ? 1 : cache.bytes / line_bytes / cache.ways;
}

int ways_of(const pipeline::CacheConfig& cache) { return cache.bytes == 0 ? 1 : cache.ways; }

/// Collects parameters; one that the source does not declare must have the value that it stands for by being absent.
class Collector {
 public:
  explicit Collector(const std::filesystem::path& top) {
    std::ifstream in(top);
    std::ostringstream text;
    text << in.rdbuf();
    source_ = text.str();
  }
  void set(const std::string& name, std::int64_t value) { parameters_.emplace_back(name, value); }
  void set_if_there(const std::string& name, std::int64_t value, std::int64_t absent, const std::string& key) {
    if (source_.find(" " + name + " =") != std::string::npos) return set(name, value);
    if (value != absent)
      throw Error(key, "the RTL does not have it, so its area is not known", "leave " + key + " at its default");
  }
  RtlParameters take() { return std::move(parameters_); }

 private:
  std::string source_;
  RtlParameters parameters_;
};

void add_caches(Collector& all, const pipeline::UnitConfig& config) {
  const int line_bytes = config.memory.line_bytes;
  all.set("LINE_BYTES", line_bytes);
  all.set("NODE_PORTS", config.node_cache.ports);
  all.set("LEAF_PORTS", config.leaf_cache.ports);
  int sets = 1, ways = 1, mshrs = 1, hit_latency = 1;
  for (const pipeline::CacheConfig* cache : {&config.node_cache, &config.leaf_cache, &config.table_cache}) {
    if (cache == &config.table_cache && cache->bytes == 0) continue;  // the tables are on chip
    sets = std::max(sets, sets_of(*cache, line_bytes));
    ways = std::max(ways, ways_of(*cache));
    mshrs = std::max(mshrs, cache->mshrs);
    hit_latency = std::max(hit_latency, cache->hit_latency);
  }
  all.set("MAX_SETS", sets);
  all.set("MAX_WAYS", ways);
  all.set("MAX_MSHRS", mshrs);
  all.set("MAX_HIT_LATENCY", hit_latency);
}

void add_latencies(Collector& all, const pipeline::UnitConfig& config) {
  const bool comparators = config.mask_test.design == Design::Comparators;
  all.set("RAY_SETUP_LATENCY", config.ray_setup.latency);
  all.set("MIN_RAY_INTERVAL", config.ray_setup.interval);
  all.set("BOX_LATENCY", config.box_test.latency);
  all.set("LOCATE_LATENCY", comparators ? config.comparators.latency : config.cell_locate.latency);
  all.set("MASK_LATENCY", config.mask_test.latency);
  all.set("MASK_SECOND_LATENCY", config.mask_test.second_latency);
  all.set("SORT_LATENCY", config.child_sort.latency);
  all.set("TRIANGLE_LATENCY", config.triangle_test.latency);
  all.set("HIT_LATENCY", config.hit_update.latency);
}

/// Of a row at the load port: as wide as the widest of the tables.
int load_bits(const cull::OnChipTables& tables) {
  int bits = kMinLoadBits;
  for (const auto& table : tables.tables()) bits = std::max(bits, static_cast<int>(table.row_bits));
  return bits;
}

void add_masks(Collector& all, const pipeline::UnitConfig& config, const cull::MaskOptions& masks) {
  const auto& test = config.mask_test;
  std::optional<cull::DedupTable> dedup;
  if (test.design == Design::Dedup) dedup.emplace(masks.resolution, masks.ray_resolution, nullptr);
  const cull::OnChipTables tables(test.design, masks, masks.entries, dedup ? &*dedup : nullptr, test.rows,
                                  test.projection_tables);
  all.set("R", masks.resolution);
  all.set("R_RAY", masks.ray_resolution);
  all.set("ENTRIES", masks.entries);
  if (test.design == Design::Dedup) all.set("DISTINCT", static_cast<std::int64_t>(tables.tables()[1].rows));
  all.set("PROJECTION_TABLES", test.projection_tables);
  all.set("BANKS", test.banks);
  all.set("PORTS", test.ports);
  all.set("UNITS", test.design == Design::Comparators ? config.comparators.units : config.cell_locate.units);
  all.set("LOAD_BITS", load_bits(tables));
  all.set_if_there("ROWS", static_cast<int>(test.rows), static_cast<int>(cull::TableRows::All), "mask_test.rows");
  const bool cached = config.table_cache.bytes > 0 && !tables.tables().empty();
  all.set_if_there("TABLE_CACHE", cached, 0, "table_cache.bytes");
  all.set_if_there("TABLE_PORTS", config.table_cache.ports, 1, "table_cache.ports");
}

constexpr std::int64_t kLeafPrimitives = 4;

void add_primitives(Collector& all, const pipeline::UnitConfig& config, const ImageParts& image) {
  all.set_if_there("PRIMITIVE_BOXES", image.primitive_boxes, 0, "--primitive-boxes");
  all.set_if_there("SPHERES", image.spheres, 0, "--spheres");
  if (image.primitive_boxes) {
    all.set("MAX_LEAF_BYTES", kLeafPrimitives * accel::primitive_bytes({.primitive_boxes = true}));
    all.set("CULL_UNITS", config.primitive_cull.units);
    all.set("CULL_LATENCY", config.primitive_cull.latency);
  }
  if (image.spheres) all.set("SPHERE_LATENCY", config.sphere_test.latency);
}

void add_packets(Collector& all, const pipeline::UnitConfig& config, int entries) {
  if (entries != 0 && (entries < 1 || entries > reference::kMostEntries))
    throw Error("--packet-entries", fmt::format("{} entries of a packet", entries),
                fmt::format("give 1 to {}, or 0 where rays travel alone", reference::kMostEntries));
  all.set_if_there("PACKETS", entries == 0 ? 0 : config.packet_cull.packets, 0, "--packet-entries");
  if (entries == 0) return;
  all.set("PACKET_ENTRIES", entries);
  all.set("PACKET_LATENCY", config.packet_cull.latency);
  all.set("MIN_PACKET_INTERVAL", config.packet_cull.interval);
}

void add_trees(Collector& all, int trees) {
  if (trees < 1 || trees > static_cast<int>(accel::kMostTrees))
    throw Error("--trees", fmt::format("{} trees in the image", trees), fmt::format("give 1 to {}", accel::kMostTrees));
  all.set_if_there("TREES", trees, 1, "--trees");
}

}  // namespace

RtlParameters unit_parameters(const pipeline::UnitConfig& config, const cull::MaskOptions& masks,
                              const std::filesystem::path& top, const ImageParts& image) {
  const Design design = config.mask_test.design;
  if (design == Design::Ideal)
    throw Error("mask_test.design", "ideal exists in software only", "choose another design");
  Collector all(top);
  all.set("DESIGN", static_cast<int>(design));
  all.set("SLOT_BITS", bits_for(config.unit.contexts));
  all.set_if_there("BOX_BITS", image.box_bits, 32, "--box-bits");
  if (image.box_bits != 32) all.set("DECODE_LATENCY", config.box_decode.latency);
  add_primitives(all, config, image);
  add_packets(all, config, image.packet_entries);
  add_trees(all, image.trees);
  all.set("STACK_ENTRIES", static_cast<int>(std::bit_ceil(static_cast<unsigned>(config.stack.entries))));
  add_caches(all, config);
  add_latencies(all, config);
  if (design != Design::None) add_masks(all, config, masks);
  return all.take();
}

}  // namespace ctu::area
