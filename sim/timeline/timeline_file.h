// Timelines as files: the viewer is chosen by the file's name.
#pragma once

#include <string>

#include "model/pipeline/timeline.h"

namespace ctu::sim {

/// The longest window, in cycles: what is seen of it is kept until the run is over.
inline constexpr pipeline::Cycle kMostTimelineCycles = 1'000'000;
/// The window when none is given: cycles 0 to 4999.
inline constexpr pipeline::Cycle kUsualTimelineCycles = 5'000;

/// Error unless the name ends in .kanata, .kanata.zst or .pftrace.
void check_timeline_name(const std::string& path);

/// Error when the run was over before the window began, or when the file cannot be written.
void write_timeline(const pipeline::Timeline& timeline, const std::string& path);

}  // namespace ctu::sim
