// How often a sample's interval holds what the run of all rays takes: the same sample with many seeds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/accel/image.h"
#include "sim/ladder/sampled.h"

namespace ctu::ladder {

/// Of `repetitions` samples with seeds from that of the options on.
struct Coverage {
  SampledOptions options;
  std::uint64_t repetitions = 0, covered = 0, whole = 0;  ///< whole: those that ran all rays; they cover
  double bias = 0, rms = 0;  ///< of the cycles, relative to the truth: mean error, and root of the mean square
  double half_width = 0;     ///< of the interval, relative: mean
  double share = 0;          ///< of the rays that were simulated: mean
  double wall_seconds = 0;   ///< of one sample: median
};

/// `truth`: cycles of the run of all rays.
Coverage measure_coverage(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config,
                          const SampledOptions& options, std::uint64_t repetitions, double truth);

/// `cycle_seconds`: run time of the run of all rays.
std::string to_table(const std::vector<Coverage>& coverages, double cycle_seconds, bool markdown);

}  // namespace ctu::ladder
