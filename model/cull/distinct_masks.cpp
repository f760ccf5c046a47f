#include "model/cull/distinct_masks.h"

#include <algorithm>

#include "model/cull/mask_numbering.h"

namespace ctu::cull {

DistinctMasks distinct_masks(const ObjectMasks& masks, const std::vector<double>& weights) {
  DistinctMasks distinct;
  distinct.words = masks.words;
  MaskNumbering numbering(masks.words);
  for (std::size_t child = 0; child < weights.size(); ++child) {
    if (!(weights[child] > 0)) continue;
    const std::size_t i = numbering.number_of(masks.bits.data() + child * static_cast<std::size_t>(masks.words));
    if (i == distinct.size()) {
      distinct.sum.push_back(0);
      distinct.largest.push_back(0);
    }
    distinct.sum[i] += weights[child];
    distinct.largest[i] = std::max(distinct.largest[i], weights[child]);
  }
  distinct.bits = numbering.masks();
  return distinct;
}

}  // namespace ctu::cull
