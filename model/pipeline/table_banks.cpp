#include "model/pipeline/table_banks.h"

#include <algorithm>

#include "model/pipeline/table_reads.h"

namespace ctu::pipeline {

TableBanks::TableBanks(const UnitConfig& config, const cull::OnChipTables& tables)
    : tables_(tables),
      bank_mask_(static_cast<std::uint32_t>(config.mask_test.banks - 1)),
      ports_(config.mask_test.ports),
      one_after_the_other_(reads_twice(config.mask_test.design)),
      cached_(config.table_cache.bytes > 0),
      shared_(config.mask_test.design == cull::Design::Projection && tables.tables().size() < 3),  // three reads a lane
      memories_(tables.tables().size()) {
  for (std::size_t m = 0; m < memories_.size(); ++m) memories_[m].used.resize(tables.tables()[m].rows);
}

TableBanks::Usage TableBanks::usage(std::size_t memory) const {
  const Memory& m = memories_[memory];
  return {m.reads, m.shared_reads, static_cast<std::uint64_t>(std::count(m.used.begin(), m.used.end(), 1))};
}

void TableBanks::read_alone(const LaneKeys& lanes, const Context& context) {
  for_each_read(tables_, lanes, context, [&](const cull::TableRead& read, std::uint32_t) {
    Memory& memory = memories_[read.table];
    ++memory.reads;
    memory.used[read.row] = 1;
  });
}

int TableBanks::read_all(const LaneKeys& lanes, const Context& context) {
  for (Memory& memory : memories_) memory.count = 0;
  for_each_read(tables_, lanes, context,
                [&](const cull::TableRead& read, std::uint32_t) { add(memories_[read.table], read.row); });
  if (cached_) return 1;
  if (one_after_the_other_) return turns(memories_[0]) + turns(memories_[1]) - 1;
  int most = 1;
  for (const Memory& memory : memories_) most = std::max(most, turns(memory));
  return most;
}

void TableBanks::add(Memory& memory, std::uint32_t row) {
  for (int i = 0; i < memory.count; ++i)
    if (memory.row[i] == row) {
      ++memory.shared_reads;
      return;
    }
  memory.row[memory.count++] = row;
  ++memory.reads;
  memory.used[row] = 1;
}

int TableBanks::turns(const Memory& memory) const {
  int most = 1;
  for (int i = 1; i < memory.count; ++i) {
    int in_bank = 1;
    for (int j = 0; j < i; ++j) in_bank += ((memory.row[j] ^ memory.row[i]) & bank_mask_) == 0;
    most = std::max(most, in_bank);
  }
  return ports_ == 1 ? most : (most + ports_ - 1) / ports_;
}

}  // namespace ctu::pipeline
