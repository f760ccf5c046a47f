// mutant [SECONDS]: the campaign of `ctusim check` with its default mix on the reference, until the first lost hit or
// for so long, a minute if nothing is given: what each mutant of the numeric core is linked with. Prints the generator
// that found it, cases and seconds; 1 when a hit was lost, 0 when not.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <fmt/format.h>

#include "sim/check/campaign.h"

namespace ctu::sim::check {
namespace {

int run(double seconds) {
  CampaignOptions options;
  for (std::uint32_t i = 0; i < generators().size(); ++i) options.generators.push_back(i);
  const SetupChoice choice{all_designs(), {}, {}, {}};
  options.draw_setup = [&](CaseRandom& random) { return draw_setup(choice, random); };
  options.make_execution = make_reference_execution;
  options.budget.seconds = seconds;
  options.stop_at_failure = true;
  const CampaignResult result = run_campaign(options);
  for (std::size_t i = 0; i < result.by_generator.size(); ++i) {
    if (result.by_generator[i].lost == 0) continue;
    fmt::print("{} {} {:.1f}\n", generators()[options.generators[i]].name, result.total().rays, result.seconds);
    return 1;
  }
  fmt::print("nothing {} {:.1f}\n", result.total().rays, result.seconds);
  return 0;
}

}  // namespace
}  // namespace ctu::sim::check

int main(int argc, char** argv) {
  try {
    return ctu::sim::check::run(argc > 1 ? std::atof(argv[1]) : 60);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
