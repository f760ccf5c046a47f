// What tailoring changed, and why: each key that differs with what it saves and what putting it back would gain, and
// each part of a unit that no trace needs.
#pragma once

#include <string>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "sim/tailor/unit_parts.h"
#include "sim/tailor/workbench.h"

namespace ctu::tailor {

struct Change {
  std::string key, before, after;
  double saved_um2 = 0;         ///< what putting it back would take
  std::int64_t saved_bits = 0;  ///< on chip, likewise
  double gain = 0;              ///< share of the cycles that putting it back would save, of the trace where most
  std::string reason;
};

/// Of each key, with the others as tailored.
std::vector<Change> changes_of(Workbench& bench, const pipeline::UnitConfig& start,
                               const pipeline::UnitConfig& tailored);

/// Sentences on the parts that the unit does not have, with why no trace needs them.
std::vector<std::string> missing_parts(const UnitParts& parts, const pipeline::UnitConfig& tailored);

/// What recording the scenes otherwise would save: boxes of reduced precision; and table rows that the runs never read.
std::vector<std::string> advice(Workbench& bench, const pipeline::UnitConfig& tailored,
                                const std::vector<std::string>& unread_rows);

}  // namespace ctu::tailor
