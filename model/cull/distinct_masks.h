// The different masks among the children of a tree, with the weights of equal ones put together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/cull/object_masks.h"

namespace ctu::cull {

/// In the order in which the masks first occur. Children without weight are left out.
struct DistinctMasks {
  int words = 1;
  std::vector<std::uint64_t> bits;
  std::vector<double> sum;      ///< of the weights of the children with this mask
  std::vector<double> largest;  ///< of these weights
  std::size_t size() const { return sum.size(); }
  const std::uint64_t* mask(std::size_t i) const { return bits.data() + i * static_cast<std::size_t>(words); }
};

/// `weights`: of every child, [node*4+lane].
DistinctMasks distinct_masks(const ObjectMasks& masks, const std::vector<double>& weights);

}  // namespace ctu::cull
