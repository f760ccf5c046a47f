#include "model/pipeline/report.h"

#include <algorithm>

#include <fmt/format.h>

namespace ctu::pipeline {
namespace {

/// "mask_test.ray_masks" of the memory "ray masks".
std::string counter_name(const cull::OnChipTable& table) {
  std::string name = "mask_test." + table.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

void add_unused_rows(const TableBanks& banks, std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < banks.tables().size(); ++i) {
    const cull::OnChipTable& table = banks.tables()[i];
    const std::uint64_t unused = table.rows - banks.usage(i).rows_used;
    if (unused > 0)
      lines.push_back(fmt::format("could be left out: {} of {} rows of {}, never read; {} of {} bits", unused,
                                  table.rows, table.name, unused * table.row_bits, table.bits()));
  }
}

}  // namespace

void CounterList::add_cache(const std::string& stage, std::uint64_t lookups, std::uint64_t hits, std::uint64_t merges,
                            std::uint64_t evictions, std::uint64_t fills, std::uint64_t most_mshrs) {
  add(stage + ".lookups", "lines", "lines looked up", lookups);
  add(stage + ".hits", "lines", "lines found in the cache", hits);
  add(stage + ".merges", "lines", "misses that joined a line already under way", merges);
  add(stage + ".fills", "lines", "lines that came from memory", fills);
  add(stage + ".evictions", "lines", "lines that gave way to another", evictions);
  add(stage + ".most_mshrs", "registers", "most miss registers in use at once", most_mshrs);
}

void CounterList::add_banked(const BankedMemory::Counters& memory) {
  add("memory.reads", "lines", "lines read", memory.reads);
  add("memory.writes", "lines", "lines written", memory.writes);
  add("memory.row_hits", "lines", "accesses to a row already open", memory.row_hits);
  add("memory.refreshes", "refreshes", "refreshes, summed over channels", memory.refreshes);
  add("memory.bus_cycles", "cycles", "cycles of data on the buses, summed over channels", memory.bus_cycles);
}

void CounterList::add_tables(const TableBanks& banks, bool cached, const CacheConfig& cache) {
  TableBanks::Usage sum;
  std::uint64_t rows = 0, bits = 0;
  for (std::size_t i = 0; i < banks.tables().size(); ++i) {
    const TableBanks::Usage& usage = banks.usage(i);
    sum.reads += usage.reads;
    sum.shared_reads += usage.shared_reads;
    sum.rows_used += usage.rows_used;
    rows += banks.tables()[i].rows;
    bits += banks.tables()[i].bits();
  }
  add("mask_test.reads", "reads", "table reads, those of one row in one cycle once", sum.reads);
  add("mask_test.shared_reads", "reads", "reads saved because another lane read the same row", sum.shared_reads);
  add("mask_test.table_bits", "bits", "all tables", bits);
  add("mask_test.on_chip_bits", "bits", cached ? "data of table_cache; the tables lie in memory" : "all tables",
      cached ? static_cast<std::uint64_t>(cache.bytes) * 8 : bits);
  add("mask_test.rows", "rows", "rows of all tables", rows);
  add("mask_test.rows_used", "rows", "rows read at least once", sum.rows_used);
  for (std::size_t i = 0; i < banks.tables().size(); ++i) {
    const cull::OnChipTable& table = banks.tables()[i];
    const std::string name = counter_name(table);
    add(name + ".rows", "rows", "rows of " + table.name, table.rows);
    add(name + ".row_bits", "bits", "bits of a row", table.row_bits);
    add(name + ".bits", "bits", "rows * row_bits", table.bits());
    add(name + ".reads", "reads", "reads of it", banks.usage(i).reads);
    add(name + ".rows_used", "rows", "rows that this trace reads", banks.usage(i).rows_used);
  }
}

std::vector<Cause> ray_cycles(const Contexts& contexts) {
  std::vector<Cause> causes;
  for (int i = 0; i < kPlaces; ++i) {
    const auto place = static_cast<Place>(i);
    const bool optional = place == Place::PrimitiveCull || place == Place::SphereTest;
    if (optional && contexts.cycles_at(place) == 0) continue;
    causes.push_back({std::string(name_of(place)), std::string(description_of(place)), contexts.cycles_at(place)});
  }
  return causes;
}

std::vector<std::string> left_out(const UnitConfig& config, const UnitImage& image, const MostUsed& most) {
  std::vector<std::string> lines;
  if (config.mask_test.design == cull::Design::None)
    lines.push_back("cell_locate and mask_test: the unit does not cull; two stages, two links and their tables");
  else if (most.table_mshrs < 0)
    lines.push_back(most.tables->tables().empty()
                        ? "table_fetch and its memory client: the design has no tables; one stage, three links"
                        : "table_fetch and its memory client: all tables are on chip; one stage, three links");
  if (image.trees() == 1) lines.push_back("the table of roots in ray_queue: all rays walk one tree");
  if (image.packet_entries() == 0) lines.push_back("packet_cull: rays do not travel in packets; one stage, four links");
  if (!image.decodes_boxes())
    lines.push_back(
        fmt::format("box_decode: the image's boxes are binary32; {} cycles of box_test", config.box_decode.latency));
  if (!image.primitive_boxes())
    lines.push_back("primitive_cull, and where a stack entry's ray leaves its box: the image has no primitive boxes");
  if (image.spheres() == 0) lines.push_back("sphere_test: the image has no spheres; one stage, one link");
  if (image.stack_bound() <= config.stack.entries)
    lines.push_back(
        fmt::format("spills of traversal_stack and their memory client: no ray of this tree can hold more than "
                    "{} entries, there are {}; two links",
                    image.stack_bound(), config.stack.entries));
  const int spare_entries = config.stack.entries - most.stack_entries;
  if (spare_entries > 0)
    lines.push_back(fmt::format("could be left out: {} of {} stack entries, never used; {} bits", spare_entries,
                                config.stack.entries, spare_entries * stack_entry_bits(image) * config.unit.contexts));
  if (most.tables != nullptr) add_unused_rows(*most.tables, lines);
  if (config.leaf_cache.bytes == 0) lines.push_back("tags and data of leaf_cache: configured away");
  if (config.node_cache.bytes == 0) lines.push_back("tags and data of node_cache: configured away");
  if (most.contexts < config.unit.contexts)
    lines.push_back(fmt::format("could be left out: {} of {} contexts, never used",
                                config.unit.contexts - most.contexts, config.unit.contexts));
  const auto spare_mshrs = [&](const char* name, int used, int configured) {
    if (used < configured)
      lines.push_back(fmt::format("could be left out: {} of {} miss registers of {}, never used", configured - used,
                                  configured, name));
  };
  spare_mshrs("node_cache", most.node_mshrs, config.node_cache.mshrs);
  spare_mshrs("leaf_cache", most.leaf_mshrs, config.leaf_cache.mshrs);
  if (most.table_mshrs >= 0) spare_mshrs("table_cache", most.table_mshrs, config.table_cache.mshrs);
  return lines;
}

}  // namespace ctu::pipeline
