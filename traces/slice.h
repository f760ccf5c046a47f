// Cuts rays out of a trace.
#pragma once

#include <string>

#include "traces/trace_feed.h"

namespace ctu::traces {

/// Writes rays [first, last) of `in` to `out`, with the image and everything recorded about them; counts are made again
/// from the steps, so designs that were counted only are left out, and of changed hits those that are listed stay.
/// Returns the hash of the new trace.
std::string slice(const std::string& in, const std::string& out, RayRange range);

}  // namespace ctu::traces
