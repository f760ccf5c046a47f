// Where a design's tables lie on chip: which rows they have, how wide a row is, and which rows a lane's test reads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/cull/mask_test.h"

namespace ctu::cull {

/// Which rows are there (contract 5).
enum class TableRows : std::uint8_t {
  All,        ///< a row for every key
  Folded,     ///< one for a key and its reverse (begin and end exchanged), mirrored keys too where a row can be mirrored
  Reachable,  ///< ... and of those only keys that a ray from outside the box can have: it begins at the box's surface
};

/// One memory on chip.
struct OnChipTable {
  std::string name;
  std::uint64_t rows = 0;
  std::uint32_t row_bits = 0;
  std::uint64_t bits() const { return rows * row_bits; }
};

/// A read that a lane's test makes.
struct TableRead {
  std::uint8_t table = 0;
  std::uint32_t row = 0;
};

inline constexpr int kMaxReadsOfLane = 4;  ///< projection over compressed masks

class OnChipTables {
 public:
  /// Throws Error when `rows` does not fit the design. `projection_tables`: 3, or 1 that is read three times a lane.
  OnChipTables(const MaskTester& tester, TableRows rows, int projection_tables);

  const std::vector<OnChipTable>& tables() const { return tables_; }
  std::uint64_t bits() const;

  /// The rows that the test of a lane reads: its key, which must not be uncertain, and its index into the compression
  /// LUT (0 when masks are not compressed). Fills `reads` and returns how many; -1 when the key's row was left out.
  int reads(CellKey key, std::uint32_t mask_index, TableRead (&reads)[kMaxReadsOfLane]) const;

 private:
  const MaskTester& tester_;
  TableRows rows_;
  std::vector<OnChipTable> tables_;
};

}  // namespace ctu::cull
