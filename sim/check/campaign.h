// Hard cases by the million: scenes are made, asked and judged on several threads, and counted in the order of their
// numbers, so that a campaign of so many cases gives the same counts for any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/check/check_scene.h"
#include "sim/check/execution.h"
#include "sim/check/tally.h"

namespace ctu::sim::check {

/// How long: until so many cases (rays) are done, or so many seconds have passed; the scene that was begun is finished.
struct Budget {
  std::uint64_t cases = 0;  ///< 0: by time
  double seconds = 0;
};

/// "1000000" is cases, "60s" seconds, "5m" minutes. Throws Error on anything else.
Budget parse_budget(const std::string& text);

struct CampaignOptions {
  std::uint64_t seed = 1;
  std::vector<std::uint32_t> generators;    ///< places in generators(), asked in turn
  std::optional<std::uint64_t> only_scene;  ///< of each generator; the budget plays no part
  DrawSetup draw_setup;
  MakeExecution make_execution;
  Budget budget;
  int threads = 1;
  bool stop_at_failure = false;           ///< no scene is begun once one has lost a hit
  std::uint64_t most_pairs = UINT64_MAX;  ///< of a ray and a triangle in a scene; rays beyond are left out
  std::size_t kept_failures = 16;         ///< the first ones, in the order of scenes
};

/// A ray whose answer is wrong.
struct Failure {
  SceneNumber number;
  std::uint32_t ray = 0;
  std::string setup;
  std::string what;
};

struct CampaignResult {
  std::vector<Tally> by_generator;  ///< as CampaignOptions::generators
  std::vector<Failure> failures;    ///< the first ones
  double seconds = 0;
  Tally total() const;
};

/// `progress` is called with cases and seconds so far, from one thread at a time.
CampaignResult run_campaign(const CampaignOptions& options,
                            const std::function<void(std::uint64_t cases, double seconds)>& progress = {});

}  // namespace ctu::sim::check
