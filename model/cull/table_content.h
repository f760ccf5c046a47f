// What the rows of a design's tables hold: what a host writes into the memories of the unit in gates.
//
// Memories and rows are those of OnChipTables. Where keys are folded by mirroring, a row holds the mask of the key that
// the fold calls canonical; the three lowest bits of an id then say on which axes the mask that the bits above number
// is to be mirrored to give that of the canonical key.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/on_chip_tables.h"

namespace ctu::cull {

class TableContent {
 public:
  /// Arguments as of OnChipTables; throws Error as it does.
  TableContent(const MaskTester& tester, TableRows rows, int projection_tables);

  const std::vector<OnChipTable>& tables() const { return tables_.tables(); }
  /// 64-bit words of a row.
  std::size_t words(std::size_t table) const { return (tables()[table].row_bits + 63) / 64; }
  const std::uint64_t* row(std::size_t table, std::uint64_t row) const {
    return bits_[table].data() + static_cast<std::size_t>(row) * words(table);
  }

 private:
  void set(std::size_t table, std::uint64_t row, const std::uint64_t* words);
  void fill_by_key(const MaskTester& tester, bool mirrors);
  /// `mirrored_resolution`: R where masks are numbered up to mirroring, else 0.
  void fill_ids(const DedupTable& dedup, std::uint32_t number, int mirrored_resolution, const TableRead& id,
                const TableRead& row);
  void fill_projections(const MaskTester& tester, bool mirrors, std::size_t count);

  OnChipTables tables_;
  std::vector<std::vector<std::uint64_t>> bits_;  ///< by table
};

}  // namespace ctu::cull
