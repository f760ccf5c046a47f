#include "sim/energy/event_energy.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/energy/on_chip_bits.h"
#include "sim/energy/stage_operations.h"
#include "sim/energy/unit_shape.h"

namespace ctu::energy {
namespace {

/// Counters by name; one that the run does not have counts nothing.
class Counts {
 public:
  explicit Counts(const pipeline::UnitResult& result) {
    for (const pipeline::Counter& counter : result.counters) values_[counter.name] = static_cast<double>(counter.value);
  }
  double operator()(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? 0 : found->second;
  }

 private:
  std::map<std::string, double> values_;
};

class Meter {
 public:
  Meter(const UnitShape& shape, const pipeline::UnitResult& result, const EnergyTable& table)
      : shape_(shape),
        table_(table),
        counts_(result),
        contexts_(shape.config.unit.contexts),
        line_bits_(8.0 * shape.config.memory.line_bytes),
        rays_(static_cast<double>(result.rays)),
        nodes_(static_cast<double>(result.counts.node_visits)),
        leaves_(static_cast<double>(result.counts.leaf_visits)),
        primitives_(static_cast<double>(result.counts.triangle_tests)) {}

  void rays() {
    operations("ray_queue", "reciprocals and shear", "rays", rays_, ray_setup_operations());
    registers("ray_queue", "registers of a ray", "rays", rays_, kRayBits + kSetupBits + kHitBits);
    registers("scheduler", "ready contexts", "visits", 2 * (nodes_ + leaves_), 64);
  }

  void fetch(const std::string& stage, const pipeline::CacheConfig& cache) {
    const double lookups = counts_(stage + ".lookups"), fills = counts_(stage + ".fills");
    if (cache.bytes > 0) {
      const double tag_bits = kAddressBits - std::log2(shape_.config.memory.line_bytes);
      const double lines = cache.bytes / shape_.config.memory.line_bytes;
      access(stage, "tags read", "lines", lookups, cache.ways * tag_bits, lines * tag_bits);
      access(stage, "tags written", "lines", fills, tag_bits, lines * tag_bits);
      access(stage, "cache read", "lines", counts_(stage + ".hits"), line_bits_, 8.0 * cache.bytes);
      access(stage, "cache written", "lines", fills, line_bits_, 8.0 * cache.bytes);
    }
    Operations search;
    search.logic_bits = cache.mshrs * kAddressBits;
    operations(stage, "miss registers searched", "lines", lookups - counts_(stage + ".hits"), search);
  }

  /// Lines kept for a context until its stage reads them.
  void span(const std::string& stage, double visits, double bytes) {
    const double bits = 8 * bytes, capacity = contexts_ * (bits + line_bits_);
    access(stage, "lines by context written", "lines", counts_(stage + ".lookups"), line_bits_, capacity);
    access(stage, "lines by context read", "visits", visits, bits, capacity);
  }

  void nodes() {
    fetch("node_fetch", shape_.config.node_cache);
    span("node_fetch", nodes_ + counts_("packets.node_visits"), shape_.node_bytes);
    registers("node_fetch", "unpacked node", "visits", nodes_, 2.0 * unpacked_node_bits(shape_));
    if (shape_.box_bits != 32) operations("box_test", "boxes decoded", "nodes", nodes_, box_decode_operations());
    operations("box_test", "slabs of four boxes", "nodes", nodes_, box_test_operations(shape_.culls()));
    registers("box_test", "ray read", "nodes", nodes_, kRayBits + kSetupBits + kHitBits);
    registers("box_test", "times written", "nodes", nodes_, kEntryTimesBits + (shape_.culls() ? kSlabTimesBits : 0));
    operations("child_sort", "order", "nodes", nodes_, child_sort_operations());
    registers("child_sort", "times read", "nodes", nodes_, kEntryTimesBits);
  }

  void culling() {
    if (!shape_.culls()) return;
    const double lanes = counts_("cell_locate.lanes");
    const int key_bits = shape_.compares() ? shape_.cells() : kKeyBits;
    operations("cell_locate", shape_.compares() ? "cells compared" : "cells located", "lanes", lanes,
               shape_.compares() ? comparator_operations(shape_.resolution) : locate_operations(shape_.ray_resolution));
    registers("cell_locate", "times and ray read", "lanes", lanes, kSlabTimesBits / 4.0 + kRayBits);
    registers("cell_locate", "keys written", "lanes", lanes, key_bits);
    registers("mask_test", "keys and masks read", "lanes", lanes, key_bits + shape_.mask_bits());
    Operations ands;
    ands.logic_bits = shape_.config.mask_test.design == cull::Design::Projection ? 3 * shape_.cells() : shape_.cells();
    operations("mask_test", "masks combined", "lanes", lanes, ands);
    if (shape_.fetches_tables()) {
      fetch("table_fetch", shape_.config.table_cache);
      access("table_fetch", "rows by context", "lines", counts_("table_fetch.lookups"), line_bits_,
             contexts_ * line_bits_);
      return;
    }
    for (const cull::OnChipTable& memory_table : shape_.tables) {
      std::string name = "mask_test." + memory_table.name;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
      access("mask_test", memory_table.name + " read", "rows", counts_(name + ".reads"), memory_table.row_bits,
             static_cast<double>(memory_table.bits()) / shape_.config.mask_test.banks);
    }
  }

  void stack() {
    const double bits = shape_.stack_entry_bits(), pushes = counts_("stack.pushes"), pops = counts_("stack.pops");
    const double capacity = contexts_ * shape_.config.stack.entries * bits;
    access("traversal_stack", "entries written", "entries", pushes, bits, capacity);
    access("traversal_stack", "entries read", "entries", pops, bits, capacity);
    operations("traversal_stack", "entries compared", "entries", pops, stack_entry_operations());
    const double batch = shape_.config.stack.spill_batch * bits;
    access("traversal_stack", "spilled and refilled", "batches", counts_("stack.spills") + counts_("stack.refills"),
           batch, capacity);
  }

  void leaves() {
    fetch("leaf_fetch", shape_.config.leaf_cache);
    span("leaf_fetch", primitives_ + counts_("primitive_cull.culled"), shape_.primitive_bytes);
    if (shape_.primitive_boxes) {
      operations("primitive_cull", "box of a ray's stay", "leaves", leaves_, ray_box_operations());
      operations("primitive_cull", "boxes compared", "boxes", counts_("primitive_cull.boxes"),
                 box_overlap_operations());
      registers("primitive_cull", "stay and ray read", "leaves", leaves_, kStayBits + kDirectionBits + kRayBits);
    }
    const double spheres = counts_("sphere_test.spheres");
    operations("triangle_test", "triangles", "triangles", primitives_ - spheres, triangle_operations());
    registers("triangle_test", "ray read", "primitives", primitives_, kRayBits + kSetupBits + kHitBits);
    if (shape_.spheres) {
      operations("sphere_test", "spheres", "spheres", spheres, sphere_operations());
      registers("sphere_test", "ray read", "spheres", spheres, kRayBits + kDirectionBits + kHitBits);
    }
    operations("hit_update", "outcomes compared", "primitives", primitives_, hit_operations());
    registers("hit_update", "best hit read", "primitives", primitives_, kHitBits);
    registers("hit_update", "best hit written", "leaves", leaves_, kHitBits);
    registers("result_queue", "hit returned", "rays", rays_, kHitBits);
  }

  void packets() {
    if (shape_.packet_rays == 0) return;
    operations("packet_cull", "slabs of four boxes", "nodes", counts_("packets.node_visits"),
               box_test_operations(false));
    registers("packet_cull", "bounds widened", "rays", counts_("packets.rays"), 2.0 * 16 * 32);
    registers("packet_cull", "entries", "entries", 2 * counts_("packets.entries"), 64);
  }

  void memory() {
    const double pj = table_.at("dram.bit");
    const auto lines = [&](const char* item, const char* counter) {
      items_.push_back({"memory", item, "lines", counts_(counter), pj * line_bits_});
    };
    lines("lines of nodes", "memory.node_requests");
    lines("lines of leaves", "memory.leaf_requests");
    lines("lines of tables", "memory.table_requests");
    const double batch = 8.0 * shape_.config.stack.spill_batch * (shape_.primitive_boxes ? 16 : 8);
    items_.push_back({"memory", "spilled batches", "batches", counts_("stack.spills"), pj * batch});
    lines("lines of refills", "stack.refills");
  }

  /// Tokens that go through links, each written once and read once.
  void links() {
    const double rows = nodes_ + counts_("packets.node_visits");
    const std::map<std::string, double> tokens = {{"ray_to_scheduler", rays_},
                                                  {"result_to_ray", rays_},
                                                  {"scheduler_to_node", rows},
                                                  {"scheduler_to_leaf", leaves_},
                                                  {"node_to_box", nodes_},
                                                  {"sort_to_stack", nodes_},
                                                  {"hit_to_stack", leaves_},
                                                  {"stack_to_scheduler", nodes_ + leaves_},
                                                  {"stack_to_result", rays_},
                                                  {"box_to_locate", nodes_},
                                                  {"mask_to_sort", nodes_},
                                                  {"locate_to_table", nodes_},
                                                  {"table_to_mask", nodes_},
                                                  {"locate_to_mask", nodes_},
                                                  {"box_to_sort", nodes_},
                                                  {"leaf_to_cull", leaves_},
                                                  {"cull_to_triangle", leaves_ - counts_("primitive_cull.emptied")},
                                                  {"cull_to_hit", counts_("primitive_cull.emptied")},
                                                  {"leaf_to_triangle", leaves_},
                                                  {"triangle_to_sphere", primitives_},
                                                  {"sphere_to_hit", primitives_},
                                                  {"triangle_to_hit", primitives_},
                                                  {"node_to_memory", counts_("memory.node_requests")},
                                                  {"memory_to_node", counts_("memory.node_requests")},
                                                  {"leaf_to_memory", counts_("memory.leaf_requests")},
                                                  {"memory_to_leaf", counts_("memory.leaf_requests")},
                                                  {"table_to_memory", counts_("memory.table_requests")},
                                                  {"memory_to_table", counts_("memory.table_requests")},
                                                  {"stack_to_memory", counts_("memory.stack_requests")},
                                                  {"memory_to_stack", counts_("stack.refills")},
                                                  {"ray_to_packet", counts_("packets.rays")},
                                                  {"packet_to_scheduler", counts_("packets.node_visits")},
                                                  {"node_to_packet", counts_("packets.node_visits")},
                                                  {"packet_to_stack", counts_("packets.rays")}};
    double bits = 0;
    for (const LinkBits& link : links_of(shape_)) {
      const auto found = tokens.find(link.name);
      if (found != tokens.end()) bits += found->second * link.bits;
    }
    items_.push_back({"link", "bits handed on", "bits", bits, 2 * table_.access_pj(0)});
  }

  std::vector<EnergyItem> take() {
    std::erase_if(items_, [](const EnergyItem& item) { return item.count == 0; });
    return std::move(items_);
  }

 private:
  void operations(const std::string& stage, const std::string& item, const std::string& unit, double count,
                  const Operations& each) {
    items_.push_back({stage, item, unit, count, each.pj(table_)});
  }
  /// Bits of a memory of so many bits.
  void access(const std::string& stage, const std::string& item, const std::string& unit, double count, double bits,
              double capacity_bits) {
    items_.push_back({stage, item, unit, count, bits * table_.access_pj(capacity_bits)});
  }
  /// Bits of a register file with a word of them for each context.
  void registers(const std::string& stage, const std::string& item, const std::string& unit, double count,
                 double bits) {
    access(stage, item, unit, count, bits, contexts_ * bits);
  }

  const UnitShape& shape_;
  const EnergyTable& table_;
  Counts counts_;
  double contexts_, line_bits_, rays_, nodes_, leaves_, primitives_;
  std::vector<EnergyItem> items_;
};

}  // namespace

bool has_event_counts(const pipeline::UnitResult& result) {
  // Results of the gates and of the reference have none of these, those of the estimate all.
  const auto has = [&](const char* name) {
    return std::any_of(result.counters.begin(), result.counters.end(), [&](const auto& c) { return c.name == name; });
  };
  return has("node_fetch.lookups") && has("memory.node_requests") && has("stack.pops");
}

std::vector<EnergyItem> event_energy(const UnitShape& shape, const pipeline::UnitResult& result,
                                     const EnergyTable& table) {
  Meter meter(shape, result, table);
  meter.rays();
  meter.packets();
  meter.nodes();
  meter.culling();
  meter.stack();
  meter.leaves();
  meter.memory();
  meter.links();
  return meter.take();
}

}  // namespace ctu::energy
