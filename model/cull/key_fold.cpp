#include "model/cull/key_fold.h"

#include <utility>

namespace ctu::cull {
namespace {

bool is_inner(int cell, int n) { return cell > 0 && cell < n - 1; }

}  // namespace

ReverseFold::ReverseFold(int ray_resolution, bool leave_out_inner) : cells_(1u << 15) {
  const int n = ray_resolution;
  std::uint32_t number = 0, inner_cells = 0;
  for (const bool inner : {true, false}) {
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
          if ((is_inner(x, n) && is_inner(y, n) && is_inner(z, n)) != inner) continue;
          cells_[static_cast<std::size_t>(x | y << 5 | z << 10)] = {number, number * (number + 1) / 2};
          ++number;
        }
    if (inner) inner_cells = number;
  }
  if (leave_out_inner) left_out_ = inner_cells * (inner_cells + 1) / 2;
  rows_ = number * (number + 1) / 2 - left_out_;
}

template <int Axes>
MirrorFold<Axes>::MirrorFold(int ray_resolution, bool leave_out_inner)
    : n_(ray_resolution),
      pairs_of_axis_(static_cast<std::uint32_t>(ray_resolution * ray_resolution)),
      left_out_from_(leave_out_inner ? kInner : kStates),
      pairs_(pairs_of_axis_),
      steps_(static_cast<std::size_t>(Axes * kStates) * pairs_of_axis_) {
  const auto pair_of = [&](int begin, int end) { return static_cast<std::size_t>(begin + n_ * end); };
  const int last = n_ - 1;
  for (int end = 0; end < n_; ++end)
    for (int begin = 0; begin < n_; ++begin) {
      const int sum = is_ascending(begin, end) ? begin + end : 2 * last - begin - end;
      const int side = begin == end ? 0 : (sum > last) - (sum < last);
      pairs_[pair_of(begin, end)] = {side, static_cast<std::uint32_t>(pair_of(end, begin))};
    }

  // From the axis that is read last: how many rows each state may still come to.
  std::uint32_t rows_from[kStates];
  for (unsigned state = 0; state < kStates; ++state) rows_from[state] = state >= left_out_from_ ? 0 : 1;
  for (int axis = 0; axis < Axes; ++axis) {
    std::uint32_t rows_before[kStates] = {};
    for (int end = 0; end < n_; ++end)
      for (int begin = 0; begin < n_; ++begin) {
        if (!is_ascending(begin, end)) continue;
        const int side = pairs_[pair_of(begin, end)].side;
        const unsigned decides = side != 0 ? 1 : 0, inner = is_inner(begin, n_) && is_inner(end, n_) ? kInner : 0;
        for (unsigned state = 0; state < kStates; ++state) {
          const bool decided = (state & 1) != 0;
          if (!decided && side > 0) continue;  // its reverse is taken instead
          const unsigned next = ((state & 1) | decides) | (state & inner);
          Step* steps = steps_.data() + table_of(axis, state);
          steps[pair_of(begin, end)] =
              steps[pair_of(last - begin, last - end)] = {rows_before[state], table_of(axis - 1, next)};
          rows_before[state] += rows_from[next];
        }
      }
    for (unsigned state = 0; state < kStates; ++state) rows_from[state] = rows_before[state];
  }
  rows_ = rows_from[kStart];
  start_ = table_of(Axes - 1, kStart);
}

template <int Axes>
FoldedKey MirrorFold<Axes>::fold(Pairs pairs) const {
  FoldedKey folded;
  folded.row = row(pairs);
  orient(pairs);
  for (int axis = 0; axis < Axes; ++axis) {
    int begin = static_cast<int>(pairs.of[axis]) % n_, end = static_cast<int>(pairs.of[axis]) / n_;
    if (!is_ascending(begin, end)) {
      folded.mirrored |= 1u << axis;
      begin = n_ - 1 - begin;
      end = n_ - 1 - end;
    }
    folded.canonical.set(axis, begin, end);
  }
  return folded;
}

template class MirrorFold<2>;
template class MirrorFold<3>;

}  // namespace ctu::cull
