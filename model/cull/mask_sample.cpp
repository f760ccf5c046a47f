#include "model/cull/mask_sample.h"

#include <cmath>

#include "model/cull/mask_words.h"

namespace ctu::cull {
namespace {

/// With more draws than that, the sample is nearly the whole, and the whole is had without drawing.
constexpr std::size_t kMostDrawsPerChild = 2;

/// Of every child: the sum up to it of weight times cells not set.
std::vector<double> running_stakes(const ObjectMasks& masks, const std::vector<double>& weights) {
  const int cells = masks.resolution * masks.resolution * masks.resolution;
  std::vector<double> stakes(weights.size());
  const std::uint64_t* mask = masks.bits.data();
  double sum = 0;
  for (std::size_t child = 0; child < weights.size(); ++child, mask += masks.words) {
    if (weights[child] > 0) sum += weights[child] * (cells - count_bits(mask, masks.words));
    stakes[child] = sum;
  }
  return stakes;
}

/// The weight that each child has in a sample of `draws` draws; 0 for those not drawn.
std::vector<double> drawn_weights(const std::vector<double>& weights, const std::vector<double>& stakes, double draws) {
  const double step = stakes.back() / draws;
  std::vector<double> drawn(weights.size());
  double before = 0, stake_before = 0;
  for (std::size_t child = 0; child < weights.size(); ++child) {
    const double stake = stakes[child] - stake_before;
    const double upto = std::floor(stakes[child] / step + 0.5);
    if (upto > before && stake > 0) drawn[child] = weights[child] * (upto - before) * step / stake;
    before = upto;
    stake_before = stakes[child];
  }
  return drawn;
}

/// Weights of all children whose masks are not full.
std::vector<double> staked_weights(const std::vector<double>& weights, const std::vector<double>& stakes) {
  std::vector<double> staked = weights;
  for (std::size_t child = 0; child < weights.size(); ++child)
    if (stakes[child] == (child == 0 ? 0 : stakes[child - 1])) staked[child] = 0;
  return staked;
}

}  // namespace

DistinctMasks sample_masks(const ObjectMasks& masks, const std::vector<double>& weights, std::size_t enough) {
  const std::vector<double> stakes = running_stakes(masks, weights);
  const std::size_t most_draws = kMostDrawsPerChild * weights.size();
  const bool any = !stakes.empty() && stakes.back() > 0;
  for (std::size_t draws = 2 * enough; any && draws < most_draws; draws *= 2) {
    const DistinctMasks sample = distinct_masks(masks, drawn_weights(weights, stakes, static_cast<double>(draws)));
    if (sample.size() >= enough) return sample;
  }
  return distinct_masks(masks, staked_weights(weights, stakes));
}

}  // namespace ctu::cull
