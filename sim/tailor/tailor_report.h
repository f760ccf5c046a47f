// What `ctusim tailor` found, for people, for pages and for programs.
#pragma once

#include <string>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "sim/run_record.h"
#include "sim/tailor/changes.h"
#include "sim/tailor/check.h"
#include "sim/tailor/unit_parts.h"

namespace ctu::tailor {

struct TailorResult {
  double slowdown = 0;                        ///< allowed
  std::vector<sim::RunRecord> before, after;  ///< of each trace, all rays
  UnitParts parts;
  std::vector<Change> changes;
  std::vector<std::string> missing, advice;
  std::vector<GateCheck> gates;

  const pipeline::UnitConfig& config() const { return after.front().config; }
  /// Every hit right, in the model and wherever gates ran; no difference between the two.
  bool is_right() const;
};

/// Rows of tables that no run read, and what they would save.
std::vector<std::string> unread_rows(const std::vector<sim::RunRecord>& records);

/// Replaces the gates of both units by what yosys finds. Error as `ctusim area`.
void synthesise(TailorResult& result, const pipeline::UnitConfig& start);

void print_report(const TailorResult& result);
/// Tables for a page.
void print_markdown(const TailorResult& result);
std::string report_json(const TailorResult& result);

}  // namespace ctu::tailor
