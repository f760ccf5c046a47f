// `ctusim check`: hard cases by the million on any execution, judged by exact arithmetic.
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/base/parallel.h"
#include "sim/check/comparison.h"
#include "sim/check/failure_files.h"
#include "sim/check/packets/packet_campaign.h"
#include "sim/check/report.h"
#include "sim/check/unit_execution.h"
#include "sim/commands.h"
#include "sim/progress.h"
#include "sim/run_record.h"
#include "sim/scene_args.h"

namespace ctu::sim {
namespace {

using check::CampaignOptions;
using check::CampaignResult;

std::uint64_t fresh_seed() {
  std::random_device device;
  std::uint64_t seed = 0;
  while (seed == 0) seed = (static_cast<std::uint64_t>(device()) << 32 | device()) >> 16;  // short enough to type
  return seed;
}

/// Of a list of generators, the place of the one with the name.
template <class Generators>
std::uint32_t generator_named(const Generators& all, const std::string& name) {
  std::vector<std::string> known;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
    known.emplace_back(all[i].name);
  }
  throw Error("--generator", fmt::format("unknown generator \"{}\"", name),
              fmt::format("did you mean \"{}\"? --list prints all", nearest_name(name, known)));
}

template <class Generators>
std::vector<std::uint32_t> chosen_generators(const Generators& all, const std::vector<std::string>& names) {
  std::vector<std::uint32_t> chosen;
  for (const std::string& name : names) chosen.push_back(generator_named(all, name));
  for (std::uint32_t i = 0; names.empty() && i < all.size(); ++i) chosen.push_back(i);
  return chosen;
}

check::SetupChoice setup_choice(const CheckArgs& args) {
  check::SetupChoice choice;
  choice.designs = args.designs.empty() ? check::all_designs() : parse_designs(args.designs);
  if (args.engine != "reference") {
    const auto removed = std::erase(choice.designs, cull::Design::Ideal);
    if (removed != 0 && !args.designs.empty())
      throw Error("--design", "ideal culling exists in software only", "choose others, or --engine reference");
  }
  if (args.resolution != 0) choice.resolution = args.resolution;
  if (args.ray_resolution != 0) choice.ray_resolution = args.ray_resolution;
  if (!args.levels.empty()) choice.levels = parse_levels(args.levels);
  if (args.box_bits != 0) {
    require_box_bits(args.box_bits);
    choice.box_bits = args.box_bits;
  }
  check::validate(choice);
  return choice;
}

template <class Generators>
void list_generators(const Generators& all) {
  for (const auto& generator : all) fmt::print("{:<24}{}\n", generator.name, generator.what);
}

/// The options that decide a scene, as they were given: with seed, generator and scene they remake it.
std::string remake_command(const CheckArgs& args, std::uint64_t seed, const check::Failure& failure) {
  std::string command =
      fmt::format("ctusim check --seed {} --generator {} --scene {} --engine {}", seed,
                  check::generators()[failure.number.generator].name, failure.number.scene, args.engine);
  if (!args.designs.empty()) command += " --design " + args.designs;
  if (args.resolution != 0) command += fmt::format(" --r {}", args.resolution);
  if (args.ray_resolution != 0) command += fmt::format(" --r-ray {}", args.ray_resolution);
  if (!args.levels.empty()) command += " --l " + args.levels;
  if (args.box_bits != 0) command += fmt::format(" --box-bits {}", args.box_bits);
  return command;
}

/// Prints the failures, and keeps them as files where a folder is given.
void report_failures(const CheckArgs& args, const CampaignOptions& options, const CampaignResult& result) {
  check::TesterCache testers;
  for (const check::Failure& failure : result.failures) {
    const std::string remake = remake_command(args, options.seed, failure);
    fmt::print("failed: {} ray {} ({}): {}\n  {}\n", check::name_of(failure), failure.ray, failure.setup, failure.what,
               remake);
    if (args.failures.empty()) continue;
    std::filesystem::create_directories(args.failures);
    const std::string path = fmt::format("{}/{}.ctut", args.failures, check::name_of(failure));
    check::CaseRandom random = check::scene_random(options.seed, failure.number);
    const check::CheckScene scene =
        check::make_scene(options.seed, failure.number, options.draw_setup, random, testers);
    check::write_one_ray_trace(scene, failure.ray, options.seed, path);
    const std::string replay = check::replay_command(scene.setup, args.engine, path);
    std::ofstream text(fmt::format("{}/{}.txt", args.failures, check::name_of(failure)));
    text << fmt::format("{}\n{}\n{}\n{}\n", failure.what, failure.setup, replay, remake);
    if (!text.flush()) throw Error(args.failures, "cannot be written to", "choose another folder");
    fmt::print("  {}\n", replay);
  }
}

/// What answers, and which setups it has.
void choose_engine(const CheckArgs& args, CampaignOptions& options) {
  const check::SetupChoice choice = setup_choice(args);
  options.draw_setup = [choice](check::CaseRandom& random) { return check::draw_setup(choice, random); };
  if (args.engine == "reference") {
    options.make_execution = check::make_reference_execution;
  } else if (args.engine == "cycle") {
    options.make_execution = check::make_cycle_execution;
  } else if (args.engine == "rtl") {
    options.draw_setup = check::draw_rtl_setup(choice);
    options.make_execution = check::make_rtl_execution;
    options.most_pairs = 1u << 15;  // duplicates by the thousand would take most of the time
  } else {
    throw Error("--engine", fmt::format("unknown value \"{}\"", args.engine), "give reference, cycle or rtl");
  }
}

CampaignOptions campaign_options(const CheckArgs& args) {
  CampaignOptions options;
  options.seed = args.seed != 0 ? args.seed : fresh_seed();
  options.generators = chosen_generators(check::generators(), args.generators);
  options.only_scene = args.scene;
  options.budget = check::parse_budget(args.budget);
  options.threads = args.threads == 0 ? available_threads() : args.threads;
  options.kept_failures = args.kept_failures;
  choose_engine(args, options);
  return options;
}

/// R, R_ray and L that all forms have; 4, R and unlimited where not given.
int compare(const CheckArgs& args, const CampaignOptions& options) {
  if (args.engine != "reference" || !args.designs.empty() || !args.failures.empty())
    throw Error("--compare",
                "sets forms of the node test in software side by side; it has no engine, design or failures",
                "leave out --engine, --design and --failures");
  cull::MaskOptions masks;
  const check::SetupChoice choice = setup_choice(args);
  masks.resolution = choice.resolution.value_or(masks.resolution);
  masks.ray_resolution = choice.ray_resolution.value_or(masks.resolution);
  masks.levels = choice.levels.value_or(masks.levels);
  check::ComparisonResult result;
  {
    Progress bar("comparing", options.budget.cases, "cases");
    result = check::compare_forms(options, masks, [&](std::uint64_t cases) { bar.update(cases); });
  }
  check::print_comparison(options, result);
  const check::ReportHead head{args.engine, args.command, options.seed, options.threads};
  if (!args.json_path.empty()) check::write_comparison(head, options, result, args.json_path);
  return result.safe_forms_lost() == 0 ? 0 : 1;
}

/// What a campaign of scenes is asked with says nothing about packets.
void require_packet_options(const CheckArgs& args) {
  const bool of_scenes = args.engine != "reference" || !args.designs.empty() || args.resolution != 0 ||
                         args.ray_resolution != 0 || !args.levels.empty() || args.box_bits != 0 || args.compare ||
                         !args.failures.empty() || !args.json_path.empty();
  if (of_scenes)
    throw Error("--packets",
                "asks the packet culling methods alone; it has no engine, design, masks, files or --compare",
                "give --budget, --seed, --generator, --scene, --threads and --max-failures only");
}

int check_packets(const CheckArgs& args) {
  require_packet_options(args);
  check::PacketCampaignOptions options;
  options.seed = args.seed != 0 ? args.seed : fresh_seed();
  options.generators = chosen_generators(check::packet_generators(), args.generators);
  options.only_case = args.scene;
  options.budget = check::parse_budget(args.budget);
  options.threads = args.threads == 0 ? available_threads() : args.threads;
  options.kept_failures = args.kept_failures;
  fmt::print("seed {}\n", options.seed);
  std::fflush(stdout);
  check::PacketCampaignResult result;
  {
    Progress bar("checking", options.budget.cases, "packets");
    result = check::run_packet_campaign(options, [&](std::uint64_t packets) { bar.update(packets); });
  }
  check::print_packet_campaign(options, result);
  for (const check::PacketFailure& failure : result.failures)
    fmt::print("failed: {}\n  ctusim check --packets --seed {} --generator {} --scene {}\n", failure.what, options.seed,
               check::packet_generators()[failure.generator].name, failure.number);
  return result.wrong() == 0 ? 0 : 1;
}

}  // namespace

int check_command(const CheckArgs& args) {
  if (args.list) {
    if (args.packets)
      list_generators(check::packet_generators());
    else
      list_generators(check::generators());
    return 0;
  }
  if (args.packets) return check_packets(args);
  const CampaignOptions options = campaign_options(args);
  if (!args.json_path.empty()) check_writable(args.json_path);
  fmt::print("seed {}\n", options.seed);
  std::fflush(stdout);
  if (args.compare) return compare(args, options);
  CampaignResult result;
  {
    Progress bar("checking", options.budget.cases, "cases");
    result = check::run_campaign(options, [&](std::uint64_t cases, double) { bar.update(cases); });
  }
  const check::ReportHead head{args.engine, args.command, options.seed, options.threads};
  check::print_report(head, options, result);
  if (!args.json_path.empty()) check::write_report(head, options, result, args.json_path);
  report_failures(args, options, result);
  return result.total().failed() ? 1 : 0;
}

}  // namespace ctu::sim
