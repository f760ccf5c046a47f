#include "sim/energy/on_chip_bits.h"

#include <algorithm>
#include <bit>

#include "sim/energy/unit_shape.h"

namespace ctu::energy {
namespace {

constexpr int kReferenceBits = 32, kNodeFields = 20, kTestedFields = 134, kMetBits = 16, kDepthBits = 8;
constexpr int kReadyBits = 64;  ///< of a context in the scheduler: its reference and when it came

int bits_for(int values) { return values <= 2 ? 1 : std::bit_width(static_cast<unsigned>(values - 1)); }
std::uint64_t product(int a, int b) { return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b); }

/// Lines that a span of so many bytes can touch when it begins at any word.
int lines_touched(std::uint32_t bytes, int line_bytes) {
  return static_cast<int>((bytes - 4 + static_cast<std::uint32_t>(line_bytes) - 1) /
                          static_cast<std::uint32_t>(line_bytes)) +
         1;
}

class Collector {
 public:
  explicit Collector(const UnitShape& shape)
      : shape_(shape), contexts_(shape.config.unit.contexts), line_bits_(8 * shape.config.memory.line_bytes) {}

  void add(const std::string& stage, const std::string& name, std::uint64_t bits, Keeping keeping = Keeping::Memory) {
    if (bits != 0) structures_.push_back({stage, name, bits, keeping});
  }
  void add_by_context(const std::string& stage, const std::string& name, int width) {
    add(stage, name, product(contexts_, width));
  }

  void add_contexts() {
    const auto file = [&](const char* name, int width) { add_by_context("context_file", name, width); };
    file("rays", kRayBits);
    file("ray setups", kSetupBits);
    file("best hits", kHitBits);
    file("entry times", kEntryTimesBits);
    if (shape_.culls()) {
      file("slab times", kSlabTimesBits);
      file("keys", 4 * (shape_.compares() ? shape_.cells() : kKeyBits));
      if (shape_.box_bits != 32) file("decoded boxes", kDecodedBoxBits);
    }
    if (shape_.primitive_boxes) {
      file("exit times", kExitTimesBits);
      file("stays", kStayBits);
    }
    if (shape_.primitive_boxes || shape_.spheres) file("directions", kDirectionBits);
    if (shape_.trees > 1) file("roots", kReferenceBits);
  }

  void add_cache(const std::string& stage, const pipeline::CacheConfig& cache) {
    const int tag_bits = kAddressBits - bits_for(shape_.config.memory.line_bytes);
    if (cache.bytes > 0) {
      const int sets = cache.bytes / shape_.config.memory.line_bytes / cache.ways;
      const int rank_bits = bits_for(cache.ways);
      add(stage, "cache data", product(cache.bytes, 8));
      add(stage, "cache tags", product(sets * cache.ways, tag_bits));
      add(stage, "cache state", product(sets, cache.ways * (1 + rank_bits)));
    }
    add(stage, "miss registers", product(cache.mshrs, tag_bits + contexts_), Keeping::Registers);
    add_by_context(stage, "queue", slot_bits(shape_));
  }

  void add_span_fetch(const std::string& stage, const pipeline::CacheConfig& cache, std::uint32_t kept_bytes) {
    add_cache(stage, cache);
    add_by_context(stage, "lines", lines_touched(kept_bytes, shape_.config.memory.line_bytes) * line_bits_);
    add_by_context(stage, "references", kReferenceBits);
  }

  void add_fetches() {
    const std::uint32_t boxes = shape_.box_bits == 32 ? 96 : 16 + 3 * shape_.box_bits;  // 24 coordinates, frame
    const auto mask_bytes = static_cast<std::uint32_t>((shape_.mask_bits() + 7) / 8);
    add_span_fetch("node_fetch", shape_.config.node_cache, boxes + 16 + 4 * mask_bytes);
    add_by_context("node_fetch", "nodes", unpacked_node_bits(shape_));
    add_span_fetch("leaf_fetch", shape_.config.leaf_cache, shape_.leaf_bytes);
    if (!shape_.fetches_tables()) return;
    add_cache("table_fetch", shape_.config.table_cache);
    add_by_context("table_fetch", "fields", kNodeFields);
    add("table_fetch", "rows by context", product(4 * contexts_, fetched_row_bits()), Keeping::Registers);
  }

  void add_tables() {
    if (shape_.fetches_tables()) return;
    const auto banks = static_cast<std::uint64_t>(shape_.config.mask_test.banks);
    for (const cull::OnChipTable& table : shape_.tables)
      add("mask_test", table.name, (table.rows + banks - 1) / banks * banks * table.row_bits);
  }

  void add_rest() {
    const int slot = slot_bits(shape_);
    add_by_context("ray_queue", "freed contexts", slot);
    if (shape_.trees > 1) add("ray_queue", "roots", product(shape_.trees, kReferenceBits));
    add_by_context("scheduler", "queues", 2 * slot);
    add_by_context("scheduler", "ready", kReadyBits);
    add_by_context("traversal_stack", "depths", 2 * kDepthBits);
    add_by_context("traversal_stack", "entries", shape_.config.stack.entries * shape_.stack_entry_bits());
    if (shape_.packet_rays > 0) {
      // Bounds of origin, reciprocal, tmin and tmax; members; entries and the search's stack: reference and time each.
      const int bounds = (2 * 6 + 4) * 32, entry = kReferenceBits + 32;
      add("packet_cull", "packets",
          product(shape_.config.packet_cull.packets,
                  bounds + shape_.packet_rays * slot + 2 * shape_.packet_entries * entry));
      if (shape_.trees > 1) add("packet_cull", "roots", product(shape_.config.packet_cull.packets, kReferenceBits));
    }
    for (const LinkBits& link : links_of(shape_))
      add("link", link.name, 2 * static_cast<std::uint64_t>(link.bits + 1), Keeping::Registers);  // and which are there
  }

  std::vector<Structure> take() { return std::move(structures_); }

 private:
  /// Bits that a lane's reads bring, with line and place of each.
  int fetched_row_bits() const {
    const int place = kAddressBits;
    int bits = 0;
    const bool three_reads = shape_.config.mask_test.design == cull::Design::Projection;
    for (const cull::OnChipTable& table : shape_.tables) {
      const bool answers = table.name == "bit table" || table.name == "bit rows";
      const bool one_of_one = three_reads && table.name == "projections";
      const int width = answers ? 8 : static_cast<int>(table.row_bits);
      bits += (one_of_one ? 3 : 1) * (width + place);
    }
    return bits;
  }

  const UnitShape& shape_;
  int contexts_, line_bits_;
  std::vector<Structure> structures_;
};

}  // namespace

int slot_bits(const UnitShape& shape) { return bits_for(shape.config.unit.contexts); }

int unpacked_node_bits(const UnitShape& shape) {
  const int boxes = shape.box_bits == 32 ? 768 : 128 + 24 * static_cast<int>(shape.box_bits);
  constexpr int kChildren = 128, kFull = 4;
  return boxes + kChildren + kFull + 4 * std::max(1, shape.mask_bits());
}

std::vector<LinkBits> links_of(const UnitShape& shape) {
  const int slot = slot_bits(shape), ref = slot + kReferenceBits, node = slot + kNodeFields,
            tested = slot + kTestedFields, request = kAddressBits + kRequestIdBits + 1,
            line = 8 * shape.config.memory.line_bytes, response = kRequestIdBits + line;
  std::vector<LinkBits> links = {{"ray_to_scheduler", ref},   {"ray_to_result", slot},     {"result_to_ray", slot},
                                 {"scheduler_to_node", ref},  {"scheduler_to_leaf", ref},  {"node_to_box", ref},
                                 {"sort_to_stack", node},     {"hit_to_stack", slot + 1},  {"stack_to_scheduler", ref},
                                 {"stack_to_result", slot},   {"node_to_memory", request}, {"memory_to_node", response},
                                 {"leaf_to_memory", request}, {"memory_to_leaf", response}};
  const auto add = [&](const char* name, int bits) { links.push_back({name, bits}); };
  if (shape.culls()) {
    add("box_to_locate", node);
    add("mask_to_sort", node);
    if (shape.fetches_tables()) {
      add("locate_to_table", node);
      add("table_to_mask", node);
      add("table_to_memory", request);
      add("memory_to_table", response);
    } else {
      add("locate_to_mask", node);
    }
  } else {
    add("box_to_sort", node);
  }
  if (shape.spills) {
    add("stack_to_memory", request + line);
    add("memory_to_stack", response);
  }
  if (shape.primitive_boxes) {
    add("leaf_to_cull", ref);
    add("cull_to_triangle", ref + kMetBits);
    add("cull_to_hit", slot);
  } else {
    add("leaf_to_triangle", ref);
  }
  if (shape.spheres) {
    add("triangle_to_sphere", tested);
    add("sphere_to_hit", tested);
  } else {
    add("triangle_to_hit", tested);
  }
  if (shape.packet_rays > 0) {
    add("ray_to_packet", ref);
    add("packet_to_scheduler", ref);
    add("node_to_packet", ref);
    add("packet_to_stack", ref);
  }
  return links;
}

std::vector<Structure> on_chip_structures(const UnitShape& shape) {
  Collector all(shape);
  all.add_contexts();
  all.add_fetches();
  all.add_tables();
  all.add_rest();
  return all.take();
}

std::uint64_t bits_of(const std::vector<Structure>& structures) {
  std::uint64_t bits = 0;
  for (const Structure& structure : structures) bits += structure.bits;
  return bits;
}

std::uint64_t bits_of(const std::vector<Structure>& structures, Keeping keeping) {
  std::uint64_t bits = 0;
  for (const Structure& structure : structures)
    if (structure.keeping == keeping) bits += structure.bits;
  return bits;
}

}  // namespace ctu::energy
