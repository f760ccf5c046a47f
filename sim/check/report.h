// What a campaign found: a table for people, JSON for programs.
#pragma once

#include <string>

#include "sim/check/campaign.h"
#include "sim/check/comparison.h"

namespace ctu::sim::check {

/// What was asked, beside the result.
struct ReportHead {
  std::string engine, command;
  std::uint64_t seed = 0;
  int threads = 1;
};

void print_report(const ReportHead& head, const CampaignOptions& options, const CampaignResult& result);

/// Throws Error when the file cannot be written.
void write_report(const ReportHead& head, const CampaignOptions& options, const CampaignResult& result,
                  const std::string& path);

void write_comparison(const ReportHead& head, const CampaignOptions& options, const ComparisonResult& result,
                      const std::string& path);

}  // namespace ctu::sim::check
