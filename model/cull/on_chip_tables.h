// Where a design's tables lie on chip: which rows they have, how wide a row is, and which rows a lane's test reads.
//
//   mask-lut     `ray masks`, R^3 bits by key
//   bit-table    `bit table`, a bit for every entry, by key
//   dedup        `ids` by key, as wide as the number of distinct masks needs; by id `distinct masks`, R^3 bits, or over
//                compressed masks `bit rows`, a bit for every entry
//   projection   `projections`, R^2 bits by the key's two axes, or three of them
//   over compressed masks `compression-lut`, R^3 bits by index, for all of these that AND masks and for comparators
//
// Rows are numbered as TableRows says: All by key number (key_number.h; projections by begin of the first axis, begin
// of the second, end, end), Folded and Reachable by MirrorFold where rows are masks and by ReverseFold where they are
// bit rows (key_fold.h). Where `ids` are folded and rows are masks, mirror images share an id too, and three bits
// beside the id say on which axes the row is mirrored. A projection has no row that a ray from outside cannot reach: it
// does not see the axis on which the ray enters.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/cull/key_fold.h"
#include "model/cull/mask_test.h"

namespace ctu::cull {

/// Which rows are there (contract 5).
enum class TableRows : std::uint8_t {
  All,     ///< a row for every key
  Folded,  ///< one for a key and its reverse (begin and end exchanged), mirrored keys too where a row can be mirrored
  Reachable,  ///< ... and of those only keys that a ray from outside the box can have: it begins at the box's surface
};

/// "all", "folded", "reachable".
std::string_view to_string(TableRows rows);

/// One memory on chip.
struct OnChipTable {
  std::string name;
  std::uint64_t rows = 0;
  std::uint32_t row_bits = 0;
  std::uint64_t bits() const { return rows * row_bits; }
};

/// Of all tables together.
std::uint64_t bits_of(const std::vector<OnChipTable>& tables);

/// A read that a lane's test makes.
struct TableRead {
  std::uint8_t table = 0;
  std::uint32_t row = 0;
};

inline constexpr int kMaxReadsOfLane = 4;  ///< projection over compressed masks

class OnChipTables {
 public:
  /// `projection_tables`: 3, or 1 that is read three times a lane; otherwise throws Error.
  OnChipTables(const MaskTester& tester, TableRows rows, int projection_tables);
  /// The same from what the sizes depend on. `entries` of the compression LUT, 0: none; `dedup`: of this design only.
  OnChipTables(Design design, const MaskOptions& options, int entries, const DedupTable* dedup, TableRows rows,
               int projection_tables);

  const std::vector<OnChipTable>& tables() const { return tables_; }
  std::uint64_t bits() const { return bits_of(tables_); }

  /// The rows that the test of a lane reads: its key, which must not be uncertain, and its index into the compression
  /// LUT (0 when masks are not compressed). Fills `reads` and returns how many; -1 when the key's row was left out.
  int reads(CellKey key, std::uint32_t mask_index, TableRead (&reads)[kMaxReadsOfLane]) const {
    int count = 0;
    const auto read = [&](int table, std::uint32_t row) { reads[count++] = {static_cast<std::uint8_t>(table), row}; };
    if (design_ == Design::Projection) {
      read(0, row_of_pair(key, 0, 1));
      read(projection_step_, row_of_pair(key, 1, 2));
      read(2 * projection_step_, row_of_pair(key, 0, 2));
    } else if (by_key_) {
      const std::uint32_t row = row_of(key);
      if (row == kNoRow) return -1;
      read(0, row);
      if (design_ == Design::Dedup) read(1, id_of_row_[row]);
    }
    if (lut_table_ >= 0) read(lut_table_, mask_index);
    return count;
  }

 private:
  enum class Numbering : std::uint8_t { ByKey, Reversed, Mirrored };

  void add(std::string name, std::uint64_t rows, int row_bits) {
    tables_.push_back({std::move(name), rows, static_cast<std::uint32_t>(row_bits)});
  }
  void add_projections(int row_bits, int projection_tables);
  void add_dedup(const DedupTable& dedup, int resolution, int entries);
  /// Numbers the masks of the rows that are there anew, mirror images alike; how many that makes.
  std::uint32_t number_canonical_masks(const DedupTable& dedup, int resolution);
  void number_rows(TableRows rows, bool rows_are_masks);
  std::uint32_t rows_by_key() const;

  std::uint32_t pair(CellKey key, int axis) const {
    return static_cast<std::uint32_t>(key.begin(axis) + n_ * key.end(axis));
  }
  std::uint32_t row_of(CellKey key) const {
    if (numbering_ == Numbering::Mirrored) return mirror_fold_.row({{pair(key, 0), pair(key, 1), pair(key, 2)}});
    return numbering_ == Numbering::ByKey ? key_number(key, n_) : reverse_fold_.row(key);
  }
  std::uint32_t row_of_pair(CellKey key, int a, int b) const {
    if (numbering_ == Numbering::Mirrored) return projection_fold_.row({{pair(key, a), pair(key, b)}});
    return static_cast<std::uint32_t>(key.begin(a) + n_ * (key.begin(b) + n_ * (key.end(a) + n_ * key.end(b))));
  }

  Design design_;
  Numbering numbering_ = Numbering::ByKey;
  bool by_key_ = false;  ///< table 0 is read by the whole key
  int n_, projection_step_ = 0;
  int lut_table_ = -1;  ///< the compression LUT among the tables
  ReverseFold reverse_fold_;
  MirrorFold<3> mirror_fold_;
  MirrorFold<2> projection_fold_;
  std::vector<std::uint32_t> id_of_row_;  ///< Dedup: the content of `ids`
  std::vector<OnChipTable> tables_;
};

/// Which rows were read at least once: what a table for one trace alone would hold (contract 5).
class UsedRows {
 public:
  explicit UsedRows(const OnChipTables& tables);
  /// A lane's test; nothing when the key's row was left out.
  void add(CellKey key, std::uint32_t mask_index);
  /// The tables with the rows used instead of all.
  std::vector<OnChipTable> tables() const;

 private:
  const OnChipTables& tables_;
  std::vector<std::vector<bool>> used_;
};

}  // namespace ctu::cull
