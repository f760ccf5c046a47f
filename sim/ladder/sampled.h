// Engine "sampled": the timed unit on chunks of the rays, with an interval that holds the cycles of the whole run at a
// stated rate.
//
// The first rays of the trace, which find the caches empty, and the last ones, after which the unit runs empty, are
// always simulated; between them chunks are drawn (chunk_plan.h) and each finds the unit as a run of all rays would
// have left it (chunk_feed.h). What a chunk's cycles are beyond what its rays and visits say varies little, and rays
// and visits of the whole trace are known from its manifest: so cycles are estimated by regression on them
// (sample_total.h).
#pragma once

#include <cstdint>
#include <functional>

#include "model/pipeline/result.h"
#include "model/pipeline/unit_config.h"
#include "sim/ladder/sample_total.h"
#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

struct SampledOptions {
  double error = 0.02;       ///< half the interval, relative to the estimate: more is drawn until it is reached
  double confidence = 0.95;  ///< with which the interval holds the cycles
  std::uint64_t seed = 1;    ///< of the chunks' places
};

/// Throws Error on an error or a confidence out of range.
void require_possible(const SampledOptions& options);

struct Sampled {
  pipeline::UnitResult result;  ///< of the whole run: sums of the sample, scaled
  double cycles_low = 0, cycles_high = 0;
  std::uint64_t chunks = 0, simulated_rays = 0, simulated_cycles = 0;
  bool whole = false;  ///< the sample would have been so large that all rays were simulated
};

/// `image`: what the unit fetches with the tester's design. Throws Error where the run itself would, and when the rays
/// travel in packets, which chunks would cut.
Sampled run_sampled(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config,
                    const SampledOptions& options);

/// One of two units that are compared.
struct Side {
  TraceWork work;
  const accel::Image& image;
  const pipeline::UnitConfig& config;
};

struct Comparison {
  Ratio ratio;  ///< cycles of the second over cycles of the first
  std::uint64_t chunks = 0, simulated_rays = 0;
};

/// The same chunks of the same trace on both: what makes a chunk longer than its visits say makes it so for both.
Comparison compare_sampled(const Side& first, const Side& second, const SampledOptions& options);

}  // namespace ctu::ladder
