// A timeline as a trace of Perfetto track events, the protobuf that ui.perfetto.dev opens.
#pragma once

#include <string>

#include "model/pipeline/timeline.h"

namespace ctu::sim {

/// Tracks in three groups: for each context its ray, the ray's visits and the places of each visit, one inside the
/// other; for each stage what it was (idle is left blank); for each link its entries. One nanosecond is one cycle.
std::string perfetto_trace(const pipeline::Timeline& timeline);

}  // namespace ctu::sim
