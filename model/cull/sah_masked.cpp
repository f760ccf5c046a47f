#include "model/cull/sah_masked.h"

#include "model/accel/statistics.h"
#include "model/cull/mask_words.h"

namespace ctu::cull {

double sah_masked(const accel::Bvh4& bvh, const ObjectMasks& masks, const SahCosts& costs) {
  const double root = accel::surface_area(bvh.lower, bvh.upper);
  if (!(root > 0)) return 0;
  const ChildWeights weights = sah_weights(bvh, costs);
  const auto words = static_cast<std::size_t>(masks.words);
  double children = 0;
  for (std::size_t child = 0; child < weights.size(); ++child)
    children += weights[child] * count_bits(masks.bits.data() + child * words, masks.words);
  const int cells = masks.resolution * masks.resolution * masks.resolution;
  return (costs.node * root + children / cells) / root;
}

}  // namespace ctu::cull
