// A timeline as a Kanata log, version 0004: the tab-separated text that the pipeline viewer Konata reads.
#pragma once

#include <string>

#include "model/pipeline/timeline.h"

namespace ctu::sim {

/// One operation for each visit of a ray, its thread the ray's context, its stages the places of the ray-latency
/// accounts. It is retired when the visit is over, and flushed when the mask test has thrown away all that it found;
/// what the window cuts stays open. An arrow goes from each visit to the ray's next one. Konata counts from the
/// window's first cycle, so cycles of the run stand in the text of each operation.
std::string kanata_log(const pipeline::Timeline& timeline);

}  // namespace ctu::sim
