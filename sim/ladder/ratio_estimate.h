// A ratio of two sums from a sample of their parts, with an interval: cycles over visits, or the cycles of one unit
// over those of another on the same rays.
#pragma once

#include <cstddef>
#include <vector>

namespace ctu::ladder {

/// One part: what it adds to the sum above and to the sum below.
struct Part {
  double above = 0, below = 0;
};

/// Parts that were drawn together: one at random from each of equally large strata, in their order. `share`: of all
/// there are, how many were drawn.
struct Drawn {
  std::vector<Part> parts;
  double share = 0;
};

struct Ratio {
  double value = 0;
  double half_width = 0;  ///< the interval is value +- half_width
  double freedom = 0;     ///< degrees of freedom
};

/// The classical ratio estimator over all draws together (Cochran 1977, "Sampling techniques", 6.3), its variance from
/// differences of neighbouring residuals, so that what changes slowly along the trace does not count as chance (Wolter
/// 2007, "Introduction to variance estimation", 8.2, estimator v2), and Student's t with the freedom of these
/// differences, 2/3 of their number (von Neumann 1941). At least one draw has two parts.
Ratio estimate_ratio(const std::vector<Drawn>& draws, double confidence);

}  // namespace ctu::ladder
