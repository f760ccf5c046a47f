// Windows into a running unit, for waveforms and for the report of a deadlock.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/pipeline/accounting.h"
#include "model/pipeline/cycle.h"

namespace ctu::pipeline {

struct LinkProbe {
  std::string name;
  std::function<bool(Cycle)> valid;  ///< something can be popped
  std::function<bool(Cycle)> ready;  ///< something can be pushed
  std::function<int()> occupancy;    ///< entries, at the start of a cycle
};

struct Probes {
  std::vector<LinkProbe> links;
  std::vector<const Account*> stages;
};

}  // namespace ctu::pipeline
