// Engine "estimate": cycles, stage occupancies and counters of a run in closed form, from the counts of a profile.
#pragma once

#include <string>

#include "model/pipeline/result.h"
#include "model/pipeline/unit_config.h"
#include "sim/ladder/profile_store.h"
#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

/// At most so many rays of a trace are profiled, in whole blocks.
inline constexpr std::uint64_t kProfiledRays = 131072;

struct Estimate {
  pipeline::UnitResult result;
  /// The stage that is busy all the time for most of the cycles, or "contexts": rays under way wait for memory and
  /// pipelines, and more of them would help.
  std::string limit;
};

/// What the profile of this work is kept under.
std::string profile_name(const TraceWork& work, const pipeline::UnitConfig& config);

/// Counts it. `image` is what the unit fetches with the tester's design. Throws Error when the rays travel in packets,
/// and when configuration and image do not fit.
VisitProfile profile_of(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config);

/// Throws Error on a configuration that cannot be.
Estimate estimate(const TraceWork& work, const VisitProfile& profile, const pipeline::UnitConfig& config);

}  // namespace ctu::ladder
