// Entry by entry, the cells whose change lowers the cost most: cells added, so that masks of larger entries fit, or one
// cell removed, so that the members which need it move out.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "model/cull/mask_clusters.h"

namespace ctu::cull {

template <int R>
class CellDescent {
 public:
  using Words = MaskWords<R>;

  explicit CellDescent(const MaskClusters<R>& clusters)
      : clusters_(clusters), points_(clusters.points()), entries_(clusters.entries()), members_(clusters.members()) {
    for (std::size_t i = 0; i < points_.size(); ++i) home_.push_back(clusters.home(i));
  }

  /// One change at most of every entry but the full one; each lowers the cost. Returns the entries.
  std::vector<std::uint64_t> run() {
    for (std::uint32_t e = 0; e + 1 < entries_.size(); ++e) {
      const Growth growth = best_growth(e);
      const Removal removal = best_removal(e);
      if (growth.gain <= 0 && removal.gain <= 0) continue;
      if (growth.gain >= removal.gain)
        grow(e, growth);
      else
        remove(e, removal);
    }
    std::vector<std::uint64_t> masks;
    for (const Entry& entry : entries_) masks.insert(masks.end(), entry.mask.begin(), entry.mask.end());
    return masks;
  }

 private:
  using Point = typename MaskClusters<R>::Point;
  using Entry = typename MaskClusters<R>::Entry;

  static constexpr int kMostAdded = 4;                ///< cells at once
  static constexpr std::size_t kMostCandidates = 24;  ///< that are weighed for one entry

  /// A mask that would fit if the entry had the missing cells too.
  struct NearMiss {
    Words missing;
    int cells, room;  ///< cells missing; cells that its home has more than the entry
    double weight;
    std::uint32_t point;
  };
  struct Growth {
    double gain = 0;
    Words cells{};
    std::vector<NearMiss> misses{};
  };
  struct Removal {
    double gain = 0;
    int cell = 0;
    std::vector<std::uint32_t> next{};  ///< of each member, the home it would have without the entry
  };

  std::vector<NearMiss> near_misses(std::uint32_t e) const {
    std::vector<NearMiss> misses;
    for (std::uint32_t other = 0; other < entries_.size(); ++other) {
      const int room = entries_[other].bits - entries_[e].bits;
      if (room < 2) continue;  // an added cell has to leave a gain
      for (const std::uint32_t i : members_[other]) {
        const Words missing = missing_in<R>(entries_[e].mask, points_[i].mask);
        const int cells = bits_of<R>(missing);
        if (cells < room && cells <= kMostAdded) misses.push_back({missing, cells, room, points_[i].weight, i});
      }
    }
    return misses;
  }

  double weight_of(std::uint32_t e) const {
    double weight = 0;
    for (const std::uint32_t i : members_[e]) weight += points_[i].weight;
    return weight;
  }

  /// Numbers of those that would gain most for themselves.
  static std::vector<std::uint32_t> largest(const std::vector<NearMiss>& misses) {
    std::vector<std::pair<double, std::uint32_t>> loss;
    for (std::uint32_t i = 0; i < misses.size(); ++i)
      loss.emplace_back(-misses[i].weight * (misses[i].room - misses[i].cells), i);
    const std::size_t count = std::min(misses.size(), kMostCandidates);
    std::partial_sort(loss.begin(), loss.begin() + static_cast<std::ptrdiff_t>(count), loss.end());
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(loss[i].second);
    return numbers;
  }

  Growth best_growth(std::uint32_t e) const {
    Growth best;
    best.misses = near_misses(e);
    const std::vector<NearMiss>& misses = best.misses;
    const double weight = weight_of(e);
    for (const std::uint32_t c : largest(misses)) {
      const NearMiss& candidate = misses[c];
      double gain = -weight * candidate.cells;
      for (const NearMiss& miss : misses)
        if (miss.room > candidate.cells && holds<R>(candidate.missing, miss.missing))
          gain += miss.weight * (miss.room - candidate.cells);
      if (gain > best.gain) {
        best.gain = gain;
        best.cells = candidate.missing;
      }
    }
    return best;
  }

  /// Another entry that holds the point: what was the tightest before cells changed, or else what is now.
  std::uint32_t next_home(std::uint32_t e, std::uint32_t i) const {
    const Point& point = points_[i];
    std::uint32_t next = clusters_.next(i);
    if (next != e && holds<R>(entries_[next].mask, point.mask)) return next;
    next = static_cast<std::uint32_t>(entries_.size()) - 1;
    for (std::uint32_t other = 0; other + 1 < entries_.size(); ++other)
      if (other != e && entries_[other].bits < entries_[next].bits && holds<R>(entries_[other].mask, point.mask))
        next = other;
    return next;
  }

  Removal best_removal(std::uint32_t e) const {
    Removal best;
    double price[MaskClusters<R>::kCells] = {};  // of the members that need a cell
    double weight = 0;
    for (const std::uint32_t i : members_[e]) {
      const std::uint32_t next = next_home(e, i);
      best.next.push_back(next);
      weight += points_[i].weight;
      const double more = points_[i].weight * (entries_[next].bits - entries_[e].bits + 1);
      for_each_cell<R>(points_[i].mask, [&](int cell) { price[cell] += more; });
    }
    for_each_cell<R>(entries_[e].mask, [&](int cell) {
      if (weight - price[cell] > best.gain) {
        best.gain = weight - price[cell];
        best.cell = cell;
      }
    });
    return best;
  }

  void move(std::uint32_t point, std::uint32_t to) {
    std::erase(members_[home_[point]], point);
    home_[point] = to;
    members_[to].push_back(point);
  }

  void grow(std::uint32_t e, const Growth& growth) {
    entries_[e].mask = union_of<R>(entries_[e].mask, growth.cells);
    const int added = bits_of<R>(growth.cells);
    entries_[e].bits += added;
    for (const NearMiss& miss : growth.misses)
      if (miss.room > added && holds<R>(growth.cells, miss.missing)) move(miss.point, e);
  }

  void remove(std::uint32_t e, const Removal& removal) {
    const std::vector<std::uint32_t> before = members_[e];
    Words left{};
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Words& mask = points_[before[i]].mask;
      if ((mask[static_cast<std::size_t>(removal.cell / 64)] >> (removal.cell % 64) & 1) != 0)
        move(before[i], removal.next[i]);
      else
        left = union_of<R>(left, mask);
    }
    entries_[e] = {left, bits_of<R>(left)};
  }

  const MaskClusters<R>& clusters_;
  const std::vector<Point>& points_;
  std::vector<Entry> entries_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<std::uint32_t> home_;
};

}  // namespace ctu::cull
