// Where a design's tables lie on chip: which rows they have, how wide a row is, and which rows a lane's test reads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/cull/mask_test.h"

namespace ctu::cull {

/// Which rows are there (contract 5).
enum class TableRows : std::uint8_t {
  All,     ///< a row for every key
  Folded,  ///< one for a key and its reverse (begin and end exchanged), mirrored keys too where a row can be mirrored
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

/// The memories of each design:
///   mask-lut     `ray masks`, R^3 bits by key
///   bit-table    `bit table`, a bit for every entry, by key
///   dedup        `ids`, as wide as the number of distinct masks needs, by key; then by id `distinct masks`, R^3 bits,
///   or
///                over compressed masks `bit rows`, a bit for every entry
///   projection   `projections`, R^2 bits by the key's two axes, or three of them
///   and over compressed masks, for all of these that AND masks and for comparators, `compression-lut`, R^3 bits by
///   index
class OnChipTables {
 public:
  /// Throws Error when `rows` does not fit the design. `projection_tables`: 3, or 1 that is read three times a lane.
  OnChipTables(const MaskTester& tester, TableRows rows, int projection_tables);

  const std::vector<OnChipTable>& tables() const { return tables_; }
  std::uint64_t bits() const;

  /// The rows that the test of a lane reads: its key, which must not be uncertain, and its index into the compression
  /// LUT (0 when masks are not compressed). Fills `reads` and returns how many; -1 when the key's row was left out.
  int reads(CellKey key, std::uint32_t mask_index, TableRead (&reads)[kMaxReadsOfLane]) const {
    int count = 0;
    const auto read = [&](int table, std::uint32_t row) { reads[count++] = {static_cast<std::uint8_t>(table), row}; };
    switch (design_) {
      case Design::MaskLut:
      case Design::BitTable:
        read(0, key_number(key, ray_resolution_));
        break;
      case Design::Dedup: {
        const std::uint32_t row = key_number(key, ray_resolution_);
        read(0, row);
        read(1, id_of_row_[row]);
        break;
      }
      case Design::Projection:
        read(0, row_of_pair(key, 0, 1));
        read(projection_step_, row_of_pair(key, 1, 2));
        read(2 * projection_step_, row_of_pair(key, 0, 2));
        break;
      default:
        break;
    }
    if (lut_table_ >= 0) read(lut_table_, mask_index);
    return count;
  }

 private:
  void add(std::string name, std::uint64_t rows, int row_bits);
  std::uint32_t row_of_pair(CellKey key, int a, int b) const {
    const int n = ray_resolution_;
    return static_cast<std::uint32_t>(key.begin(a) + n * (key.begin(b) + n * (key.end(a) + n * key.end(b))));
  }

  Design design_;
  TableRows rows_;
  int ray_resolution_, projection_step_ = 0;
  int lut_table_ = -1;                    ///< the compression LUT among the tables
  std::vector<std::uint32_t> id_of_row_;  ///< Dedup: the content of `ids`
  std::vector<OnChipTable> tables_;
};

}  // namespace ctu::cull
