#include "model/accel/split.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace ctu::accel {
namespace {

constexpr std::size_t kSweepTriangles = 8;  // up to here sorting costs less than binning
constexpr float kFlatExtent = 1e-30f;       // of centres; the refs are scaled to extent about 1

/// The best cut found so far. Among equal costs the most even one, so that equal boxes give an even tree.
struct BestCut {
  float cost = std::numeric_limits<float>::infinity();
  std::size_t imbalance = 0;
  int axis = -1;
  int position = 0;

  void offer(float cut_cost, std::size_t left, std::size_t right, int cut_axis, int cut_position) {
    const std::size_t cut_imbalance = left < right ? right - left : left - right;
    if (axis >= 0 && !(cut_cost < cost || (cut_cost == cost && cut_imbalance < imbalance))) return;
    cost = cut_cost;
    imbalance = cut_imbalance;
    axis = cut_axis;
    position = cut_position;
  }
};

Box3 centre_bounds(std::span<const TriangleRef> refs) {
  Box3 bounds = Box3::empty();
  for (const TriangleRef& ref : refs) bounds.grow(ref.centre2());
  return bounds;
}

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

void fill_bins(std::span<const TriangleRef> refs, const BinMap& map, int count, Bin (&bins)[3][kMaxBins]) {
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

void sweep_bins(const Bin (&bins)[kMaxBins], int count, int axis, std::size_t triangles, BestCut& best) {
  float right_area[kMaxBins];
  Box3 box = Box3::empty();
  std::size_t right = 0;
  for (int i = count - 1; i > 0; --i) {
    box.grow(bins[i].box);
    right += bins[i].count;
    right_area[i] = right == 0 ? 0.0f : half_area(box);
  }
  box = Box3::empty();
  std::size_t left = 0;
  for (int i = 1; i < count; ++i) {
    box.grow(bins[i - 1].box);
    left += bins[i - 1].count;
    right = triangles - left;
    if (left == 0 || bins[i - 1].count == 0) continue;  // an empty bin moves nothing
    if (right == 0) return;
    best.offer(half_area(box) * static_cast<float>(left) + right_area[i] * static_cast<float>(right), left, right, axis,
               i);
  }
}

std::size_t split_binned(std::span<TriangleRef> refs, int bins) {
  const BinMap map(centre_bounds(refs), bins);
  if (map.axes() == 0) return split_median(refs);
  Bin table[3][kMaxBins];
  fill_bins(refs, map, bins, table);
  BestCut best;
  for (int axis = 0; axis < 3; ++axis)
    if ((map.axes() >> axis) & 1) sweep_bins(table[axis], bins, axis, refs.size(), best);
  if (best.axis < 0) return split_median(refs);
  const auto limit = static_cast<std::uint32_t>(best.position);
  return partition(refs, [&](const TriangleRef& ref) { return map(ref)[best.axis] < limit; });
}

using Order = std::array<std::uint8_t, kSweepTriangles>;

/// Positions of the refs by centre on one axis; equal centres keep their order.
Order sorted(std::span<const TriangleRef> refs, int axis) {
  std::array<float, kSweepTriangles> key;
  Order order{};
  for (std::size_t i = 0; i < refs.size(); ++i) {
    const float k = refs[i].centre2(axis);
    std::size_t at = i;
    for (; at > 0 && key[at - 1] > k; --at) {
      key[at] = key[at - 1];
      order[at] = order[at - 1];
    }
    key[at] = k;
    order[at] = static_cast<std::uint8_t>(i);
  }
  return order;
}

std::size_t split_swept(std::span<TriangleRef> refs) {
  const std::size_t n = refs.size();
  BestCut best;
  std::array<Order, 3> orders;
  for (int axis = 0; axis < 3; ++axis) {
    const Order& order = orders[axis] = sorted(refs, axis);
    std::array<float, kSweepTriangles> right_area;
    Box3 box = Box3::empty();
    for (std::size_t i = n - 1; i > 0; --i) {
      box.grow(refs[order[i]].box);
      right_area[i] = half_area(box);
    }
    box = Box3::empty();
    for (std::size_t i = 1; i < n; ++i) {
      box.grow(refs[order[i - 1]].box);
      best.offer(half_area(box) * static_cast<float>(i) + right_area[i] * static_cast<float>(n - i), i, n - i, axis,
                 static_cast<int>(i));
    }
  }
  std::array<TriangleRef, kSweepTriangles> moved;
  for (std::size_t i = 0; i < n; ++i) moved[i] = refs[orders[best.axis][i]];
  std::copy_n(moved.begin(), n, refs.begin());
  return static_cast<std::size_t>(best.position);
}

int widest_axis(const Box3& box) {
  alignas(16) float extent[4];
  _mm_store_ps(extent, _mm_sub_ps(box.upper, box.lower));
  const int xy = extent[1] > extent[0] ? 1 : 0;
  return extent[2] > extent[xy] ? 2 : xy;
}

}  // namespace

std::size_t split_sah(std::span<TriangleRef> refs, int bins) {
  if (refs.size() == 2) return 1;
  return refs.size() <= kSweepTriangles ? split_swept(refs) : split_binned(refs, bins);
}

std::size_t split_median(std::span<TriangleRef> refs) {
  const int axis = widest_axis(centre_bounds(refs));
  const std::size_t half = refs.size() / 2;
  std::nth_element(refs.begin(), refs.begin() + static_cast<std::ptrdiff_t>(half), refs.end(),
                   [axis](const TriangleRef& a, const TriangleRef& b) {
                     const float ka = a.centre2(axis), kb = b.centre2(axis);
                     return ka != kb ? ka < kb : a.id() < b.id();
                   });
  return half;
}

}  // namespace ctu::accel
