// `ctusim check --compare`: what the naive forms of the node test lose, and what the safe ones give up for it, on the
// campaign's own cases.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "sim/check/campaign.h"

namespace ctu::sim::check {

/// The forms compared: Algorithm 1 in plain binary32, its entry and exit times padded by a part of themselves, its
/// boxes by a part of their longest side; and the unit's two ways to be sure, tables by located cells and comparators.
inline constexpr std::array<std::string_view, 6> kForms = {"plain",     "t +1e-6", "t +1e-4",
                                                           "box +1e-4", "tables",  "comp."};

inline constexpr std::size_t kNaiveForms = 4;  ///< the first ones

/// Each ray goes through the whole tree with its own [tmin, tmax]: no hit shortens it.
struct FormCounts {
  std::uint64_t lost = 0;      ///< exact hits whose leaf the ray does not come to
  std::uint64_t box_hits = 0;  ///< lanes, and of them
  std::uint64_t culled = 0;
  std::uint64_t tests = 0;  ///< nodes visited and triangles tested
};

struct ComparisonRow {
  std::uint64_t rays = 0, exact_hits = 0;
  std::array<FormCounts, kForms.size()> forms;
  ComparisonRow& operator+=(const ComparisonRow& other);
};

struct ComparisonResult {
  std::vector<ComparisonRow> by_generator;  ///< as CampaignOptions::generators
  double seconds = 0;
  /// Hits that the unit's own forms have lost.
  std::uint64_t safe_forms_lost() const;
};

/// Of the options: seed, generators, budget and threads. `masks`: R, R_ray and L; leaves of up to four triangles. All
/// generators have made the same number of scenes when it ends.
ComparisonResult compare_forms(const CampaignOptions& options, const cull::MaskOptions& masks,
                               const std::function<void(std::uint64_t cases)>& progress = {});

/// By form, what the table shows of a generator.
struct FormFigures {
  std::array<double, kForms.size()> lost_per_million{};  ///< of exact hits
  std::array<double, kForms.size()> culled_share{};      ///< of box hits
  std::array<double, kForms.size()> tests_per_ray{};
};
FormFigures figures_of(const ComparisonRow& row);
/// Every generator weighs the same.
FormFigures mean_figures(const ComparisonResult& result);

void print_comparison(const CampaignOptions& options, const ComparisonResult& result);

}  // namespace ctu::sim::check
