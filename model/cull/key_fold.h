// Which keys can share a row, and the rows' numbers: functions small enough for gates.
//
// A key and its reverse (begin and end exchanged) sweep the same cells. A key mirrored on an axis (cell c becomes
// n - 1 - c at begin and end, n = R_ray) sweeps the mirrored cells, exactly: two half-open cells overlap in more than a
// face or not at all, and that has no preferred direction.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/cell_locate.h"

namespace ctu::cull {

inline constexpr std::uint32_t kNoRow = ~std::uint32_t{0};

/// Rows for a key and its reverse, for rows that cannot be mirrored (bit rows).
///
/// In gates: each cell has a number c, inner cells first, and c (c + 1) / 2, both from a table of n^3 constants; a
/// compare-and-swap brings the larger number to the front; row = larger (larger + 1) / 2 + smaller - rows left out,
/// these being the pairs of two inner cells.
class ReverseFold {
 public:
  ReverseFold() = default;
  /// `leave_out_inner`: no rows for keys that neither begin nor end at the box's surface.
  ReverseFold(int ray_resolution, bool leave_out_inner);
  std::uint32_t rows() const { return rows_; }
  /// kNoRow when it was left out.
  std::uint32_t row(CellKey key) const {
    const Cell begin = cells_[key.packed & 0x7FFFu], end = cells_[key.packed >> 15 & 0x7FFFu];
    const std::uint32_t row =
        begin.number < end.number ? end.pairs_before + begin.number : begin.pairs_before + end.number;
    return row < left_out_ ? kNoRow : row - left_out_;
  }

 private:
  struct Cell {
    std::uint32_t number = 0, pairs_before = 0;  ///< c, c (c + 1) / 2
  };
  std::uint32_t rows_ = 0, left_out_ = 0;
  std::vector<Cell> cells_;  ///< by the 15 bits of a cell in a key
};

/// A key brought to the form that has a row: `row` is that of `canonical`, and the mask of the key is the mask of
/// `canonical`, mirrored on the axes of `mirrored` (bit axis).
struct FoldedKey {
  std::uint32_t row = kNoRow;
  CellKey canonical;
  unsigned mirrored = 0;
};

/// Rows for a key, its reverse and all their mirrored forms, for rows that are masks; Axes = 2 for projections.
///
/// In gates: (1) On each axis, mirror the pair (begin, end) if end < begin, or if begin = end > n - 1 - begin: now it
/// ascends. (2) On the last axis whose pair is not its own mirrored reverse (begin = end, or begin + end = n - 1), if
/// begin + end > n - 1, reverse the key and mirror all axes with begin < end: all pairs ascend again. (3) row = the sum
/// of a number from each axis, last axis first, each from a table of constants by the pair and by two bits that say
/// whether all axes before were their own mirrored reverses and whether they had inner cells only.
template <int Axes>
class MirrorFold {
 public:
  /// begin + n * end of each axis.
  struct Pairs {
    std::uint32_t of[Axes];
  };

  MirrorFold() = default;
  /// `leave_out_inner`: no rows for keys whose begin and end are both inner cells.
  MirrorFold(int ray_resolution, bool leave_out_inner);
  std::uint32_t rows() const { return rows_; }

  /// kNoRow when it was left out.
  std::uint32_t row(Pairs pairs) const {
    orient(pairs);
    std::uint32_t row = 0, table = start_;
    for (int axis = Axes - 1; axis >= 0; --axis) {
      const Step step = steps_[table + pairs.of[axis]];
      row += step.rows_before;
      table = step.next;
    }
    return row | table;  // the last table is 0, or kNoRow where there is no row
  }

  FoldedKey fold(Pairs pairs) const;

 private:
  // Bit 0: an axis so far decided the orientation; bit 1: all cells so far are inner.
  static constexpr int kStates = 4;
  static constexpr unsigned kStart = 2, kInner = 2;
  struct Step {
    std::uint32_t rows_before = 0;
    std::uint32_t next = 0;  ///< where the next axis' steps begin, for the state that this pair leads to
  };
  /// Of a pair, the same for its mirrored form.
  struct Pair {
    std::int32_t side = 0;  ///< 0: its own mirrored reverse; otherwise -1 for one of the two and 1 for the other
    std::uint32_t reversed = 0;
  };

  /// Where the steps of an axis begin for a state; past the last axis what row() adds at the end.
  std::uint32_t table_of(int axis, unsigned state) const {
    if (axis < 0) return state >= left_out_from_ ? kNoRow : 0;
    return (static_cast<std::uint32_t>(axis * kStates) + state) * pairs_of_axis_;
  }

  void orient(Pairs& pairs) const {
    // The last axis that is not 0 decides; as a sum, because rays make branches hard to foresee.
    int side = 0;
    for (int axis = Axes - 1; axis >= 0; --axis) side = 2 * side + pairs_[pairs.of[axis]].side;
    const std::uint32_t other = side > 0 ? ~std::uint32_t{0} : 0;
    for (std::uint32_t& pair : pairs.of) pair ^= (pair ^ pairs_[pair].reversed) & other;
  }
  bool is_ascending(int begin, int end) const { return begin < end || (begin == end && 2 * begin <= n_ - 1); }

  int n_ = 0;
  std::uint32_t pairs_of_axis_ = 0, start_ = 0;
  std::uint32_t rows_ = 0;
  unsigned left_out_from_ = kStates;  ///< final states from here on have no row
  std::vector<Pair> pairs_;
  std::vector<Step> steps_;  ///< [(axis * states + state) * pairs + pair]
};

}  // namespace ctu::cull
