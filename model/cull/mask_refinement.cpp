#include "model/cull/mask_refinement.h"

#include <algorithm>

#include "model/cull/cell_descent.h"
#include "model/cull/cluster_exchange.h"
#include "model/cull/mask_clusters.h"

namespace ctu::cull {
namespace {

constexpr int kPhases = 2;           // of exchanges, then of cell changes
constexpr int kMostExchanges = 40;   // rounds of a phase
constexpr int kMostDescents = 3;     // likewise
constexpr double kWorthMore = 2e-3;  // a round that lowers the cost by a smaller share is the last of its kind

/// Takes the entries unless they cost more; returns by which share the cost fell.
template <int R>
double settle_if_better(MaskClusters<R>& clusters, const std::vector<std::uint64_t>& masks) {
  const double before = clusters.cost();
  const std::vector<std::uint64_t> kept = clusters.masks();
  clusters.settle(masks);
  if (clusters.cost() < before) return 1 - clusters.cost() / before;
  clusters.settle(kept);
  return 0;
}

/// Many exchanges a round at first; fewer when their estimates, which take each for itself, no longer come true.
template <int R>
void exchange(MaskClusters<R>& clusters, int entries) {
  const int rounds = std::clamp(kMostExchanges * 512 / entries, 4, kMostExchanges);  // pairs of entries are looked at
  int moves = std::max(1, entries / 4);
  for (int round = 0; round < rounds && moves > 0; ++round) {
    const auto masks = ClusterExchange<R>(clusters).run(moves, static_cast<std::size_t>(entries));
    if (masks.empty()) break;
    if (settle_if_better<R>(clusters, masks) < kWorthMore) moves /= 2;
  }
}

template <int R>
void descend(MaskClusters<R>& clusters) {
  for (int round = 0; round < kMostDescents; ++round)
    if (settle_if_better<R>(clusters, CellDescent<R>(clusters).run()) < kWorthMore) break;
}

}  // namespace

std::vector<std::uint64_t> refine_masks(int resolution, const DistinctMasks& masks,
                                        const std::vector<std::uint64_t>& start, int entries) {
  return with_resolution(resolution, [&](auto r) {
    MaskClusters<r()> clusters(masks, start);
    for (int phase = 0; phase < kPhases; ++phase) {
      exchange<r()>(clusters, entries);
      descend<r()>(clusters);
    }
    return clusters.masks();
  });
}

}  // namespace ctu::cull
