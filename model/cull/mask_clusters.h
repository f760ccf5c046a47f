// Weighted masks, the entries of a LUT in the making, and which entry each mask is replaced by: the state that the
// moves of mask_refinement.cpp work on.
//
// A mask lives with an entry that holds it: its home. The cost, which is what Eq. 2 adds by compression, is the sum
// over the masks of weight times the cells that the home has and the mask has not.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/cull/cell_bits.h"
#include "model/cull/compression_lut.h"
#include "model/cull/distinct_masks.h"
#include "model/cull/requirement_luts.h"

namespace ctu::cull {

template <int R>
int bits_of(const MaskWords<R>& mask) {
  int count = 0;
  for (int w = 0; w < kWords<R>; ++w) count += std::popcount(mask[w]);
  return count;
}

template <int R>
MaskWords<R> union_of(const MaskWords<R>& a, const MaskWords<R>& b) {
  MaskWords<R> both;
  for (int w = 0; w < kWords<R>; ++w) both[w] = a[w] | b[w];
  return both;
}

/// Cells of `mask` that `entry` has not.
template <int R>
MaskWords<R> missing_in(const MaskWords<R>& entry, const MaskWords<R>& mask) {
  MaskWords<R> missing;
  for (int w = 0; w < kWords<R>; ++w) missing[w] = mask[w] & ~entry[w];
  return missing;
}

template <int R>
bool holds(const MaskWords<R>& outer, const MaskWords<R>& inner) {
  return holds<R>(outer.data(), inner);
}

/// Calls `body(cell)` for each set cell.
template <int R, class Body>
void for_each_cell(const MaskWords<R>& mask, Body&& body) {
  for (int w = 0; w < kWords<R>; ++w)
    for (std::uint64_t bits = mask[w]; bits != 0; bits &= bits - 1) body(64 * w + std::countr_zero(bits));
}

template <int R>
class MaskClusters {
 public:
  using Words = MaskWords<R>;
  static constexpr int kCells = R * R * R;

  struct Point {
    Words mask;
    int bits;
    double weight;
  };
  struct Entry {
    Words mask;
    int bits;
  };

  MaskClusters(const DistinctMasks& masks, const std::vector<std::uint64_t>& start) {
    for (std::size_t i = 0; i < masks.size(); ++i) {
      Point point;
      std::copy_n(masks.mask(i), kWords<R>, point.mask.begin());
      point.bits = bits_of<R>(point.mask);
      point.weight = masks.sum[i];
      points_.push_back(point);
    }
    settle(start);
  }

  const std::vector<Point>& points() const { return points_; }
  /// In the order of a CompressionLut, the last one full.
  const std::vector<Entry>& entries() const { return entries_; }
  std::uint16_t home(std::size_t point) const { return home_[point]; }
  /// The tightest entry but the home that holds the point; the full entry when there is none or it is the home.
  std::uint16_t next(std::size_t point) const { return next_[point]; }
  /// Numbers of the points that live with an entry.
  std::vector<std::vector<std::uint32_t>> members() const {
    std::vector<std::vector<std::uint32_t>> members(entries_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) members[home_[i]].push_back(static_cast<std::uint32_t>(i));
    return members;
  }
  double cost() const { return cost_; }
  /// Of each entry: the weight of its members, and what its members would cost more without it.
  const std::vector<double>& weight() const { return weight_; }
  const std::vector<double>& drop_cost() const { return drop_cost_; }

  /// All entries' masks, one behind the other.
  std::vector<std::uint64_t> masks() const {
    return flat(entries_, [](const Entry& entry) { return entry.mask; });
  }

  /// Replaces the entries; every point moves to the tightest one; then every entry but the full one is cut down to the
  /// union of its members, which costs nothing and may let more points move; entries without members are left out.
  void settle(const std::vector<std::uint64_t>& masks) {
    assign(masks);
    std::vector<Words> unions(entries_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) unions[home_[i]] = union_of<R>(unions[home_[i]], points_[i].mask);
    std::vector<Words> used;
    for (std::size_t e = 0; e + 1 < entries_.size(); ++e)
      if (weight_[e] > 0) used.push_back(unions[e]);
    assign(flat(used, [](const Words& mask) { return mask; }));
  }

 private:
  template <class Items, class MaskOf>
  static std::vector<std::uint64_t> flat(const Items& items, MaskOf&& mask_of) {
    std::vector<std::uint64_t> words;
    for (const auto& item : items) {
      const Words mask = mask_of(item);
      words.insert(words.end(), mask.begin(), mask.end());
    }
    return words;
  }

  void assign(const std::vector<std::uint64_t>& masks) {
    const CompressionLut lut(R, masks);
    const RequirementLuts search(lut);
    entries_.resize(static_cast<std::size_t>(lut.entries()));
    for (int e = 0; e < lut.entries(); ++e) {
      Entry& entry = entries_[static_cast<std::size_t>(e)];
      std::copy_n(lut.entry(e), kWords<R>, entry.mask.begin());
      entry.bits = lut.set_bits(e);
    }
    home_.resize(points_.size());
    next_.resize(points_.size());
    weight_.assign(entries_.size(), 0);
    drop_cost_.assign(entries_.size(), 0);
    cost_ = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point& point = points_[i];
      const int home = search.find(point.mask.data());
      const int next = home + 1 < lut.entries() ? search.find(point.mask.data(), home + 1) : home;
      home_[i] = static_cast<std::uint16_t>(home);
      next_[i] = static_cast<std::uint16_t>(next);
      weight_[home_[i]] += point.weight;
      drop_cost_[home_[i]] += point.weight * (lut.set_bits(next) - lut.set_bits(home));
      cost_ += point.weight * (lut.set_bits(home) - point.bits);
    }
  }

  std::vector<Point> points_;
  std::vector<Entry> entries_;
  std::vector<std::uint16_t> home_, next_;
  std::vector<double> weight_, drop_cost_;
  double cost_ = 0;
};

}  // namespace ctu::cull
