#include "model/pipeline/report.h"

#include <fmt/format.h>

namespace ctu::pipeline {

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

std::vector<Cause> ray_cycles(const Contexts& contexts) {
  std::vector<Cause> causes;
  for (int i = 0; i < kPlaces; ++i) {
    const auto place = static_cast<Place>(i);
    causes.push_back({std::string(name_of(place)), std::string(description_of(place)), contexts.cycles_at(place)});
  }
  return causes;
}

std::vector<std::string> left_out(const UnitConfig& config, const UnitImage& image, const TableBanks* tables,
                                  int deepest_stack, int most_contexts, int most_node_mshrs, int most_leaf_mshrs) {
  std::vector<std::string> lines;
  if (config.mask_test.design == cull::Design::None)
    lines.push_back("cell_locate and mask_test: the unit does not cull; two stages, two links and their tables");
  if (image.stack_bound() <= config.stack.entries)
    lines.push_back(
        fmt::format("spills of traversal_stack and their memory client: no ray of this tree can hold more than "
                    "{} entries, there are {}; two links",
                    image.stack_bound(), config.stack.entries));
  const int spare_entries = config.stack.entries - deepest_stack;
  if (spare_entries > 0)
    lines.push_back(fmt::format("could be left out: {} of {} stack entries, never used; {} bits", spare_entries,
                                config.stack.entries, spare_entries * kStackEntryBytes * 8 * config.unit.contexts));
  if (tables != nullptr && tables->rows() > 0) {
    const std::uint64_t rows = tables->rows() * static_cast<std::uint64_t>(tables->tables());
    const std::uint64_t unused = rows - tables->rows_used();
    if (unused > 0)
      lines.push_back(fmt::format("could be left out: {} of {} table rows, never read; {} of {} bits", unused, rows,
                                  unused * tables->row_bits(), tables->bits()));
  }
  if (config.leaf_cache.bytes == 0) lines.push_back("tags and data of leaf_cache: configured away");
  if (config.node_cache.bytes == 0) lines.push_back("tags and data of node_cache: configured away");
  if (most_contexts < config.unit.contexts)
    lines.push_back(fmt::format("could be left out: {} of {} contexts, never used",
                                config.unit.contexts - most_contexts, config.unit.contexts));
  const auto spare_mshrs = [&](const char* name, int most, int configured) {
    if (most < configured)
      lines.push_back(fmt::format("could be left out: {} of {} miss registers of {}, never used", configured - most,
                                  configured, name));
  };
  spare_mshrs("node_cache", most_node_mshrs, config.node_cache.mshrs);
  spare_mshrs("leaf_cache", most_leaf_mshrs, config.leaf_cache.mshrs);
  return lines;
}

}  // namespace ctu::pipeline
