// The result of a run as JSON, the one form that files, sweeps and reports share.
#pragma once

#include <string>

#include "sim/run_record.h"

namespace ctu::sim {

/// The text of a result file, without a newline at its end.
std::string json_text(const RunRecord& record);

}  // namespace ctu::sim
