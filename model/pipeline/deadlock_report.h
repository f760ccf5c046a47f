// What one wants to see when nothing moves any more.
#pragma once

#include <string>

#include "model/pipeline/context.h"
#include "model/pipeline/probe.h"

namespace ctu::pipeline {

/// Every link, every stage, and the ray that has been in the unit longest.
std::string deadlock_report(Cycle now, Cycle last_moved, const Probes& probes, const Contexts& contexts);

}  // namespace ctu::pipeline
