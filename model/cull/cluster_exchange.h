// Moving entries of a LUT in the making to where they gain more: one entry is given up (its masks go to others, or it
// is merged with another), and another is split in two.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "model/cull/mask_clusters.h"

namespace ctu::cull {

template <int R>
class ClusterExchange {
 public:
  using Words = MaskWords<R>;

  explicit ClusterExchange(const MaskClusters<R>& clusters) : clusters_(clusters) {}

  /// The entries after at most `moves` exchanges that gain by estimate, the best ones first, of which no two touch the
  /// same entry; while there are fewer than `most` entries, splits alone. Empty when nothing gains.
  std::vector<std::uint64_t> run(int moves, std::size_t most) {
    const std::vector<Split> splits = find_splits();
    if (splits.empty()) return {};
    const std::vector<Release> releases = find_releases(splits.front().gain);
    std::vector<char> touched(clusters_.entries().size()), gone(clusters_.entries().size());
    std::vector<Words> added;
    std::size_t room = most - std::min(most, clusters_.entries().size());
    auto release = releases.begin();
    for (const Split& split : splits) {
      if (moves == 0) break;
      if (touched[split.entry]) continue;
      touched[split.entry] = 1;
      if (room > 0) {
        --room;
      } else {
        while (release != releases.end() && (touched[release->entry] || touched[release->partner])) ++release;
        if (release == releases.end() || release->cost >= split.gain) break;
        touched[release->entry] = touched[release->partner] = 1;
        gone[release->entry] = 1;
        if (release->partner != release->entry) {
          gone[release->partner] = 1;
          added.push_back(release->merged);
        }
      }
      added.push_back(split.part);
      --moves;
    }
    return added.empty() ? std::vector<std::uint64_t>{} : remaining(gone, added);
  }

 private:
  /// The members of `entry` without some cell get an entry of their own.
  struct Split {
    double gain;
    std::uint32_t entry;
    Words part;
  };
  /// `entry` is dropped (partner == entry) or merged with its partner.
  struct Release {
    double cost;
    std::uint32_t entry, partner;
    Words merged;
  };

  std::vector<Split> find_splits() const {
    std::vector<Split> splits;
    const auto members = clusters_.members();
    for (std::uint32_t e = 0; e < members.size(); ++e) {
      const Split split = best_split(e, members[e]);
      if (split.gain > 0) splits.push_back(split);
    }
    std::stable_sort(splits.begin(), splits.end(), [](const Split& a, const Split& b) { return a.gain > b.gain; });
    return splits;
  }

  Split best_split(std::uint32_t e, const std::vector<std::uint32_t>& members) const {
    const auto& entry = clusters_.entries()[e];
    double weight[MaskClusters<R>::kCells] = {};  // of the members that lack a cell
    Words part[MaskClusters<R>::kCells] = {};     // ... and their union
    for (const std::uint32_t i : members) {
      const auto& point = clusters_.points()[i];
      for_each_cell<R>(missing_in<R>(point.mask, entry.mask), [&](int cell) {
        weight[cell] += point.weight;
        part[cell] = union_of<R>(part[cell], point.mask);
      });
    }
    Split best{0, e, {}};
    for (int cell = 0; cell < MaskClusters<R>::kCells; ++cell) {
      if (weight[cell] == 0) continue;
      const double gain = weight[cell] * (entry.bits - bits_of<R>(part[cell]));
      if (gain > best.gain) best = {gain, e, part[cell]};
    }
    return best;
  }

  /// An entry heavier than `limit` is not looked at: to give it up costs at least its weight.
  std::vector<Release> find_releases(double limit) const {
    std::vector<Release> releases;
    for (std::uint32_t e = 0; e + 1 < clusters_.entries().size(); ++e)
      if (clusters_.weight()[e] < limit) releases.push_back(cheapest_release(e));
    std::stable_sort(releases.begin(), releases.end(),
                     [](const Release& a, const Release& b) { return a.cost < b.cost; });
    return releases;
  }

  Release cheapest_release(std::uint32_t e) const {
    const auto& entries = clusters_.entries();
    const std::vector<double>& weight = clusters_.weight();
    Release best{clusters_.drop_cost()[e], e, e, {}};
    for (std::uint32_t other = 0; other + 1 < entries.size(); ++other) {
      if (other == e) continue;
      const Words merged = union_of<R>(entries[e].mask, entries[other].mask);
      const int bits = bits_of<R>(merged);
      const double cost = weight[e] * (bits - entries[e].bits) + weight[other] * (bits - entries[other].bits);
      if (cost < best.cost) best = {cost, e, other, merged};
    }
    return best;
  }

  std::vector<std::uint64_t> remaining(const std::vector<char>& gone, const std::vector<Words>& added) const {
    std::vector<std::uint64_t> masks;
    const auto append = [&](const Words& mask) { masks.insert(masks.end(), mask.begin(), mask.end()); };
    for (std::size_t e = 0; e < gone.size(); ++e)
      if (!gone[e]) append(clusters_.entries()[e].mask);
    for (const Words& mask : added) append(mask);
    return masks;
  }

  const MaskClusters<R>& clusters_;
};

}  // namespace ctu::cull
