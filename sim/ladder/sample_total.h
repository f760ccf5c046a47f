// The sum of something over all chunks of a trace from a sample of them, when sizes of a chunk, whose sums are known,
// say most of it: cycles, from rays, node visits and leaf visits. And how far off it may be.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ctu::ladder {

inline constexpr std::size_t kSizes = 3;
using Sizes = std::array<double, kSizes>;

struct Measure {
  double value = 0;
  Sizes sizes{};
  std::size_t group = 0;
};

/// Chunks that were drawn together, in their order: of each group so many, `share_within` of it, and groups,
/// `share_of_groups` of all. Every chunk had the same probability.
struct Draw {
  std::vector<Measure> chunks;
  double share_of_groups = 1, share_within = 1;
};

struct Total {
  double value = 0;
  double weight = 0;  ///< how many chunks one of the sample stands for
  /// By draw and chunk: what its sizes do not say of its value, judged by all other chunks.
  std::vector<std::vector<double>> residuals;
};

/// What was seen, and for the rest a regression of the values on their sizes, without a constant: the first size is
/// about the same for all chunks (Cochran 1977, "Sampling techniques", 7.8; least squares over all draws). Every chunk
/// is judged by the fit to all others, as in Quenouille's jackknife (1956), and the mean is taken: the plain estimator
/// is off by what a heavy chunk pulls the fit to itself, this one is free of bias for a simple random draw. `totals`:
/// of all chunks; sizes from `known` on are not known. At least one chunk, of a first size above 0.
Total estimate_total(const std::vector<Draw>& draws, const Sizes& totals, std::size_t known);

struct Spread {
  double variance = 0;
  double freedom = 1;  ///< degrees of freedom
};

/// Of the sum of the chunks' residuals: between groups and within them (two stages, Cochran 10.4), each from
/// differences of neighbours, so that what changes slowly along the trace does not count as chance (Wolter 2007,
/// "Introduction to variance estimation", 8.2, estimator v2). Freedom: of n differences 2/3 n (von Neumann 1941), both
/// stages together by Satterthwaite's rule. `residuals` as in Total.
Spread spread_of_sum(const std::vector<Draw>& draws, const std::vector<std::vector<double>>& residuals);

/// Half of the interval that holds the total of `value` with the probability `confidence`.
double half_width(const std::vector<Draw>& draws, const Total& total, double confidence);

struct Ratio {
  double value = 0;
  double half_width = 0;  ///< the interval is value +- half_width
};

/// Of two totals of the same chunks.
Ratio estimate_ratio(const std::vector<Draw>& draws, const Total& above, const Total& below, double confidence);

}  // namespace ctu::ladder
