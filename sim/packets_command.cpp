// `ctusim packets`: what packets save or cost in the unit, in tests and cycles, per scene and kind of rays.
#include <charconv>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/reference/packet_walk.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/packet_survey.h"
#include "sim/progress.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"

namespace ctu::sim {
namespace {

/// Where no configuration says otherwise: rays that wait for their packet leave enough others to work on.
constexpr int kContexts = 128;

std::vector<int> parse_numbers(const std::string& option, const std::string& list) {
  std::vector<int> numbers;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    int number = 0;
    const auto [last, error] = std::from_chars(list.data() + begin, list.data() + end, number);
    if (error != std::errc() || last != list.data() + end)
      throw Error(option, fmt::format("\"{}\" is no list of numbers", list),
                  fmt::format("write it as in {} 4,8", option));
    numbers.push_back(number);
    begin = end + 1;
  }
  return numbers;
}

PacketSurveyOptions options_of(const PacketsArgs& args) {
  PacketSurveyOptions options;
  std::vector<std::string> sets = args.unit.sets;
  if (args.unit.config_path.empty()) sets.insert(sets.begin(), fmt::format("unit.contexts={}", kContexts));
  options.config = load_config(args.unit.config_path, sets);
  options.sizes = parse_numbers("--packets", args.sizes);
  options.entries = parse_numbers("--packet-entries", args.entries);
  const auto forming = reference::forming_from_string(args.forming);
  if (!forming)
    throw Error("--packet-forming", fmt::format("\"{}\" is no way to form packets", args.forming),
                "give order, direction or origin");
  options.forming = *forming;
  options.window = args.window;
  options.rays = args.rays;
  for (const int size : options.sizes) {
    if (size > options.config.unit.contexts)
      throw Error("--packets",
                  fmt::format("{} rays, more than the unit's {} contexts", size, options.config.unit.contexts),
                  "give smaller ones, or more contexts: --set unit.contexts=128");
    reference::check(reference::FormingOptions{.size = size, .window = std::max(size, args.window)});
    for (const int entries : options.entries) reference::check(reference::PacketPlan{size, entries});
  }
  return options;
}

void print_header(bool markdown) {
  if (markdown)
    fmt::print(
        "| scene | rays | N | E | box tests/ray | triangle tests/ray | saved/ray | packet visits/ray | entries | "
        "lines/ray | cycles/ray | against alone | other hits |\n"
        "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  else
    fmt::print("{:<18}{:<10}{:>4}{:>4}{:>10}{:>10}{:>9}{:>9}{:>9}{:>8}{:>10}{:>11}{:>7}\n", "scene", "rays", "N", "E",
               "box tests", "triangles", "saved", "packets'", "entries", "lines", "cycles", "more", "other");
}

void print_row(const std::string& scene, const std::string& rays, const PacketRun& run, const PacketRun& alone,
               bool markdown) {
  const bool in_packets = run.plan.any();
  const auto number = [&](double value, const char* format) {
    return in_packets ? fmt::format(fmt::runtime(format), value) : std::string("-");
  };
  fmt::print(
      fmt::runtime(markdown ? "| {} | {} | {} | {} | {:.3f} | {:.3f} | {} | {} | {} | {:.3f} | {:.3f} | {} | {} |\n"
                            : "{:<18}{:<10}{:>4}{:>4}{:>10.3f}{:>10.3f}{:>9}{:>9}{:>9}{:>8.3f}{:>10.3f}{:>11}{:>7}\n"),
      scene, rays, in_packets ? std::to_string(run.plan.size) : "-",
      in_packets ? std::to_string(run.plan.most_entries) : "-", run.node_tests, run.triangle_tests,
      number(run.node_tests_saved, "{:.3f}"), number(run.packet_visits, "{:.3f}"), number(run.entries, "{:.2f}"),
      run.memory_lines, run.cycles, number(100 * (run.cycles / alone.cycles - 1), "{:+.1f} %"),
      run.near_misses + run.ties);
  std::fflush(stdout);
}

}  // namespace

int packets_command(const PacketsArgs& args) {
  const PacketSurveyOptions options = options_of(args);
  bool sound = true;
  fmt::print("{} contexts, {} packets under way, mask test {}; packets by {}\n\n", options.config.unit.contexts,
             options.config.packet_cull.packets, to_string(options.config.mask_test.design),
             reference::to_string(options.forming));
  print_header(args.markdown);
  for (const ListedScene& listed : listed_scenes(args.scene)) {
    const std::optional<scene::Scene> scene = load_listed(args.scene, listed);
    if (!scene) continue;
    std::optional<traces::RecordedTree> tree;
    for (const std::string& kind : ray_kinds(args.scene.rays)) {
      SceneArgs one = args.scene;
      one.rays = kind;
      traces::RecordOptions recorded = record_options(one);
      require_possible(options.config.mask_test.design, recorded.masks);
      recorded.rays.tiled = true;  // so that packets of pixels are square
      recorded.rays.skip_primary |= recorded.rays.kind == traces::RayOptions::Rays::Diffuse;
      if (!tree) tree = traces::build_tree(*scene, recorded);
      Progress bar(listed.name + " " + kind, 0, "runs");
      const std::vector<PacketRun> runs =
          survey_packets(*scene, *tree, recorded, options, [&](std::uint64_t done) { bar.update(done); });
      for (const PacketRun& run : runs) {
        print_row(listed.name, kind, run, runs.front(), args.markdown);
        sound &= run.lost == 0;
      }
    }
  }
  return sound ? 0 : 1;
}

}  // namespace ctu::sim
