// A result as parts/ keep it and as `collect` shows it. Nothing in a row depends on the machine, the runner or the
// time: what was timed goes into a line of its own.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sim/sweep/point.h"

namespace ctu::sweep {

/// "done": every ray had the expected hit. "wrong": it ran to its end and a hit was another. The rest have no result:
/// "refused" (the unit cannot be built, or the trace lacks what it asks for), "deadlock", "out-of-memory", "timeout",
/// "crashed".
inline constexpr const char* kDone = "done";
inline constexpr const char* kWrong = "wrong";

/// A line of parts/*.jsonl, without its end, from the JSON that `ctusim run --json` writes.
std::string result_line(const Point& point, const std::string& run_json);
/// The same of a point that has none.
std::string failure_line(const Point& point, const std::string& status, const std::string& message);
/// Whether a line tells of a run to its end with every hit right.
bool is_right_line(const std::string& line);
/// What the run took, from the same JSON, and where.
std::string timing_line(const Point& point, const std::string& run_json, double seconds, std::uint64_t peak_bytes);

/// The whole row: what the point is, then what came of it. `line` is of the same id.
nlohmann::ordered_json joined_row(const Point& point, const std::string& line);

}  // namespace ctu::sweep
