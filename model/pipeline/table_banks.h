// Where the mask test's tables lie on chip, and how many cycles a node's reads of them take.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/mask_test.h"
#include "model/pipeline/outcome.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

/// Resident tables of the configured design. Row r lies in bank r mod banks; a bank answers `ports` reads a cycle.
/// Lanes that read the same row of the same table share one read. Keys that are uncertain are not read.
class TableBanks {
 public:
  TableBanks(const UnitConfig& config, const cull::MaskTester& tester);

  /// Cycles that the reads of these keys take: the most over the banks of ceil(reads / ports); at least 1.
  int read(const LaneKeys& keys) { return design_ == cull::Design::Comparators ? 1 : read_tables(keys); }

  std::uint64_t reads() const { return reads_; }
  std::uint64_t shared_reads() const { return shared_; }
  /// Rows of one table, bits of a row, tables on chip.
  std::uint64_t rows() const { return rows_; }
  std::uint64_t row_bits() const { return row_bits_; }
  int tables() const { return tables_; }
  std::uint64_t bits() const { return rows_ * row_bits_ * static_cast<std::uint64_t>(tables_); }
  /// Rows read at least once, over all tables.
  std::uint64_t rows_used() const { return rows_used_; }

 private:
  static constexpr int kMaxTables = 3;
  static constexpr int kMaxReads = 12;  // three for each lane

  /// The reads of one node at one table.
  struct Reads {
    int count = 0;
    std::uint32_t row[kMaxReads];
  };

  int read_tables(const LaneKeys& keys);
  void add(int table, std::uint32_t row);
  int most_in_a_bank(const Reads& reads) const;

  cull::Design design_;
  const cull::MaskTester& tester_;
  std::uint32_t bank_mask_;
  int ports_, tables_ = 0;
  std::uint64_t rows_ = 0, row_bits_ = 0;
  std::vector<bool> used_;  // [table * rows + row]
  std::uint64_t reads_ = 0, shared_ = 0, rows_used_ = 0;
  Reads pending_[kMaxTables];
};

}  // namespace ctu::pipeline
