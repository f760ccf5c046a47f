// How a range of triangles is cut in two: binned (Wald 2007), an exact sweep for a few triangles, and the median where
// neither can go on. What a cut costs and which axes are asked is the heuristic's (split_heuristic.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "model/accel/split_heuristic.h"
#include "model/accel/triangle_ref.h"

namespace ctu::accel {

inline constexpr int kMaxBins = 64;

/// Reorders `refs` and returns how many go to the left: 1 .. size-1. `refs` has at least two, and `box` is theirs, with
/// the chance of a visit `chance`. The order that results depends on the order given and on nothing else.
template <class Heuristic>
std::size_t split(std::span<TriangleRef> refs, const Box3& box, float chance, int bins, const Heuristic& heuristic);

/// Halves `refs` (left: the smaller half) at the median centre of the widest axis, ties by id.
std::size_t split_median(std::span<TriangleRef> refs);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

inline constexpr std::size_t kSweepTriangles = 8;  // up to here sorting costs less than binning
inline constexpr float kFlatExtent = 1e-30f;       // of centres; the refs are scaled to extent about 1

Box3 centre_bounds(std::span<const TriangleRef> refs);

/// Moves the refs of which `goes_left` holds to the front; returns how many.
template <class Predicate>
std::size_t partition(std::span<TriangleRef> refs, Predicate goes_left) {
  TriangleRef* left = refs.data();
  TriangleRef* right = refs.data() + refs.size();
  for (;;) {
    while (left < right && goes_left(*left)) ++left;
    while (left < right && !goes_left(right[-1])) --right;
    if (left >= right) return static_cast<std::size_t>(left - refs.data());
    std::swap(*left++, *--right);
  }
}

/// Maps centres to bins; an axis on which the centres do not differ has all of them in bin 0.
class BinMap {
 public:
  BinMap(const Box3& centres, int bins) : origin_(centres.lower), last_(_mm_set1_ps(static_cast<float>(bins - 1))) {
    const __m128 extent = _mm_sub_ps(centres.upper, centres.lower);
    const __m128 usable = _mm_cmpgt_ps(extent, _mm_set1_ps(kFlatExtent));
    scale_ = _mm_and_ps(usable, _mm_div_ps(_mm_set1_ps(static_cast<float>(bins)), extent));
    axes_ = _mm_movemask_ps(usable) & 7;
  }
  int axes() const { return axes_; }  ///< bit a: axis a can be cut
  __m128i bins_of(const TriangleRef& ref) const {
    return _mm_cvttps_epi32(_mm_min_ps(_mm_mul_ps(_mm_sub_ps(ref.centre2(), origin_), scale_), last_));
  }
  std::array<std::uint32_t, 4> operator()(const TriangleRef& ref) const {
    alignas(16) std::array<std::uint32_t, 4> bin;
    _mm_store_si128(reinterpret_cast<__m128i*>(bin.data()), bins_of(ref));
    return bin;
  }

 private:
  __m128 origin_, scale_, last_;
  int axes_;
};

struct Bin {
  Box3 box;
  std::size_t count;
};

inline void fill_bins(std::span<const TriangleRef> refs, const BinMap& map, int count, Bin (&bins)[3][kMaxBins]) {
  for (auto& row : bins) std::fill_n(row, count, Bin{Box3::empty(), 0});
  for (const TriangleRef& ref : refs) {
    const auto at = map(ref);
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = bins[axis][at[axis]];
      bin.box.grow(ref.box);
      ++bin.count;
    }
  }
}

/// The best cut across `axis` between two bins.
template <class Chance>
Cut sweep_bins(const Bin (&bins)[kMaxBins], int count, int axis, std::size_t triangles, const Chance& chance) {
  float right_chance[kMaxBins];
  Box3 box = Box3::empty();
  std::size_t right = 0;
  for (int i = count - 1; i > 0; --i) {
    box.grow(bins[i].box);
    right += bins[i].count;
    right_chance[i] = right == 0 ? 0.0f : chance(box);
  }
  Cut best;
  box = Box3::empty();
  std::size_t left = 0;
  for (int i = 1; i < count; ++i) {
    box.grow(bins[i - 1].box);
    left += bins[i - 1].count;
    right = triangles - left;
    if (left == 0 || bins[i - 1].count == 0) continue;  // an empty bin moves nothing
    if (right == 0) break;
    best.offer(make_cut(chance(box), left, right_chance[i], right, axis, i));
  }
  return best;
}

template <class Heuristic>
std::size_t split_binned(std::span<TriangleRef> refs, const Box3& box, float chance, int bins,
                         const Heuristic& heuristic) {
  const BinMap map(centre_bounds(refs), bins);
  if (map.axes() == 0) return split_median(refs);
  Bin table[3][kMaxBins];
  fill_bins(refs, map, bins, table);
  const Cut best = heuristic.axes.choose(box, chance, [&](int axis) {
    return ((map.axes() >> axis) & 1) != 0 ? sweep_bins(table[axis], bins, axis, refs.size(), heuristic.chance) : Cut{};
  });
  if (best.axis < 0) return split_median(refs);
  const auto limit = static_cast<std::uint32_t>(best.position);
  return partition(refs, [&](const TriangleRef& ref) { return map(ref)[best.axis] < limit; });
}

using Order = std::array<std::uint8_t, kSweepTriangles>;

/// Positions of the refs by centre on one axis; equal centres keep their order.
Order sorted(std::span<const TriangleRef> refs, int axis);

/// The best cut between two refs of the order.
template <class Chance>
Cut sweep_order(std::span<const TriangleRef> refs, const Order& order, int axis, const Chance& chance) {
  const std::size_t n = refs.size();
  std::array<float, kSweepTriangles> right_chance;
  Box3 box = Box3::empty();
  for (std::size_t i = n - 1; i > 0; --i) {
    box.grow(refs[order[i]].box);
    right_chance[i] = chance(box);
  }
  Cut best;
  box = Box3::empty();
  for (std::size_t i = 1; i < n; ++i) {
    box.grow(refs[order[i - 1]].box);
    best.offer(make_cut(chance(box), i, right_chance[i], n - i, axis, static_cast<int>(i)));
  }
  return best;
}

template <class Heuristic>
std::size_t split_swept(std::span<TriangleRef> refs, const Box3& box, float chance, const Heuristic& heuristic) {
  std::array<Order, 3> orders;
  const Cut best = heuristic.axes.choose(box, chance, [&](int axis) {
    orders[axis] = sorted(refs, axis);
    return sweep_order(refs, orders[axis], axis, heuristic.chance);
  });
  const std::size_t n = refs.size();
  std::array<TriangleRef, kSweepTriangles> moved;
  for (std::size_t i = 0; i < n; ++i) moved[i] = refs[orders[best.axis][i]];
  std::copy_n(moved.begin(), n, refs.begin());
  return static_cast<std::size_t>(best.position);
}

}  // namespace detail

template <class Heuristic>
std::size_t split(std::span<TriangleRef> refs, const Box3& box, float chance, int bins, const Heuristic& heuristic) {
  if (refs.size() == 2) return 1;
  return refs.size() <= detail::kSweepTriangles ? detail::split_swept(refs, box, chance, heuristic)
                                                : detail::split_binned(refs, box, chance, bins, heuristic);
}

}  // namespace ctu::accel
