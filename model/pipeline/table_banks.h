// How many cycles a node's reads of the mask test's tables take, and what of the tables was read.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/on_chip_tables.h"
#include "model/pipeline/outcome.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

/// Each memory of the design has mask_test.banks banks: row r lies in bank r mod banks, and a bank answers `ports`
/// reads a cycle. Lanes that read the same row of the same memory share one read. Memories are read side by side; only
/// Dedup's second waits for its first. Tables behind a cache have no banks: their rows come with the node
/// (table_fetch.h).
class TableBanks {
 public:
  TableBanks(const UnitConfig& config, const cull::OnChipTables& tables);

  /// Cycles that the reads of these lanes take, at least 1: of a memory the most over its banks of ceil(reads / ports),
  /// of all memories the most; of Dedup's two the sum less one, as the second turn of reads begins when the ids are
  /// there. Throws Error as for_each_read does.
  int read(const LaneKeys& lanes, const Context& context) {
    if (lanes.count == 0 || memories_.empty()) return 1;
    if (lanes.count > 1 || shared_) return read_all(lanes, context);
    read_alone(lanes, context);
    return 1;
  }

  struct Usage {
    std::uint64_t reads = 0;         ///< those of one row in one cycle once
    std::uint64_t shared_reads = 0;  ///< saved, as another lane read the row
    std::uint64_t rows_used = 0;     ///< rows read at least once
  };
  /// Of a memory, by its number in OnChipTables::tables().
  Usage usage(std::size_t memory) const;
  const std::vector<cull::OnChipTable>& tables() const { return tables_.tables(); }

 private:
  static constexpr int kMaxReads = 3 * intersect::kLanes;  // a single projection table, three reads a lane

  struct Memory {
    int count = 0;  ///< rows that the node reads
    std::uint32_t row[kMaxReads];
    std::uint64_t reads = 0, shared_reads = 0;
    std::vector<std::uint8_t> used;  ///< by row, 1: read at least once
  };

  /// Most nodes have one lane that asks, whose reads meet nobody else's.
  void read_alone(const LaneKeys& lanes, const Context& context);
  int read_all(const LaneKeys& lanes, const Context& context);
  static void add(Memory& memory, std::uint32_t row);
  int turns(const Memory& memory) const;

  const cull::OnChipTables& tables_;
  std::uint32_t bank_mask_;
  int ports_;
  bool one_after_the_other_, cached_;
  bool shared_;  ///< a lane reads a memory more than once
  std::vector<Memory> memories_;
};

}  // namespace ctu::pipeline
