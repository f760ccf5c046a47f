// `ctusim precision`: boxes of fewer bits, error (intersections) against cost (bytes, lines, cycles).
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/paper/plot.h"
#include "sim/precision_survey.h"
#include "sim/progress.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"

namespace ctu::sim {
namespace {

std::vector<std::uint32_t> parse_bits(const std::string& list) {
  std::vector<std::uint32_t> bits;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    std::uint32_t number = 0;
    const auto [last, error] = std::from_chars(list.data() + begin, list.data() + end, number);
    if (error != std::errc() || last != list.data() + end)
      throw Error("--box-bits", fmt::format("\"{}\" is no list of numbers", list), "write it as in --box-bits 32,16,8");
    require_box_bits(number);
    bits.push_back(number);
    begin = end + 1;
  }
  return bits;
}

/// Of the run with the same design and the first number of bits.
const PrecisionRun& base_of(const PrecisionSurvey& survey, const PrecisionRun& run) {
  for (const PrecisionRun& one : survey.runs)
    if (one.design == run.design) return one;
  return run;
}

double percent_more(double part, double whole) { return whole == 0 ? 0 : 100 * (part / whole - 1); }

void print_header(bool markdown) {
  if (markdown)
    fmt::print(
        "| scene | mask test | bits | bytes a node | intersections/ray | more | node bytes/ray | more | "
        "lines from memory/ray | more | cycles/ray | more | wrong hits | near-misses |\n"
        "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  else
    fmt::print("{:<20}{:<14}{:>4}{:>6}{:>10}{:>10}{:>11}{:>9}{:>9}{:>9}{:>10}{:>9}{:>7}{:>7}\n", "scene", "mask test",
               "bits", "bytes", "inters.", "more", "node bytes", "more", "lines", "more", "cycles", "more", "wrong",
               "near");
}

void print_rows(const std::string& scene, const PrecisionSurvey& survey, bool markdown) {
  const char* const format =
      markdown ? "| {} | {} | {} | {} | {:.3f} | {:+.2f} % | {:.1f} | {:+.1f} % | {:.3f} | {:+.1f} % | {:.2f} | "
                 "{:+.1f} % | {} | {} |\n"
               : "{:<20}{:<14}{:>4}{:>6}{:>10.3f}{:>8.2f} %{:>11.1f}{:>7.1f} %{:>9.3f}{:>7.1f} %{:>10.2f}{:>7.1f} "
                 "%{:>7}{:>7}\n";
  for (const PrecisionRun& run : survey.runs) {
    const PrecisionRun& base = base_of(survey, run);
    fmt::print(fmt::runtime(format), scene, to_string(run.design), run.box_bits, run.node_bytes,
               run.intersections_per_ray, percent_more(run.intersections_per_ray, base.intersections_per_ray),
               run.node_bytes_per_ray, percent_more(run.node_bytes_per_ray, base.node_bytes_per_ray),
               run.memory_lines_per_ray, percent_more(run.memory_lines_per_ray, base.memory_lines_per_ray),
               run.cycles_per_ray, percent_more(run.cycles_per_ray, base.cycles_per_ray), run.lost_hits,
               run.near_misses + run.ties);
  }
  std::fflush(stdout);
}

struct SceneSurvey {
  std::string name;
  PrecisionSurvey survey;
};

/// A line for each run, relative to the first number of bits, in percent.
std::string plot_data(const std::vector<SceneSurvey>& scenes) {
  std::string text = "scene,design,bits,intersections_more,node_bytes_more,lines_more,cycles_more\n";
  for (const auto& [name, survey] : scenes)
    for (const PrecisionRun& run : survey.runs) {
      const PrecisionRun& base = base_of(survey, run);
      text += fmt::format("{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}\n", name, to_string(run.design), run.box_bits,
                          percent_more(run.intersections_per_ray, base.intersections_per_ray),
                          percent_more(run.node_bytes_per_ray, base.node_bytes_per_ray),
                          percent_more(run.memory_lines_per_ray, base.memory_lines_per_ray),
                          percent_more(run.cycles_per_ray, base.cycles_per_ray));
    }
  return text;
}

/// A row of panels for each design: intersections, node bytes, cycles, each against the bits.
std::string plot_script(const std::vector<SceneSurvey>& scenes) {
  std::string names, designs;
  for (const SceneSurvey& scene : scenes) names += fmt::format("{}{}", names.empty() ? "" : " ", scene.name);
  const std::vector<PrecisionRun>& runs = scenes.front().survey.runs;
  std::size_t rows = 0;
  for (; rows < runs.size() && runs[rows].box_bits == runs.front().box_bits; ++rows)
    designs += fmt::format("{}{}", rows == 0 ? "" : " ", to_string(runs[rows].design));
  std::string text = fmt::format(R"(set datafile separator ','
set datafile missing NaN
set terminal svg noenhanced size 1200,{} font 'sans,13' background 'white'
set output 'precision.svg'
scenes = '{}'
designs = '{}'
set multiplot layout {},3 margins 0.06,0.84,0.07,0.90 spacing 0.07,0.12 \
  title 'Bits of a coordinate of the boxes: error and cost, relative to {} bits' font ',16'
)",
                                 120 + 260 * rows, names, designs, rows, runs.front().box_bits);
  text += R"(set grid ytics lc rgb '#dddddd'
set xlabel 'bits'
set logscale x 2
set xrange [36:7]
set xtics ('32' 32, '16' 16, '12' 12, '8' 8)
set key at screen 0.995,0.9 right top samplen 2 font ',11'
colors = '#1f77b4 #d62728 #2ca02c #9467bd #ff7f0e #8c564b #e377c2 #17becf'
array titles[3] = ['intersections, % more', 'node bytes fetched, % more', 'cycles, % more']
array columns[3] = [4, 5, 7]
do for [d = 1:words(designs)] {
  do for [p = 1:3] {
    set title word(designs, d) . ': ' . titles[p]
    c = columns[p]
    plot for [i = 1:words(scenes)] 'precision.csv' skip 1 \
      using 3:(strcol(1) eq word(scenes, i) && strcol(2) eq word(designs, d) ? column(c) : NaN) \
      with linespoints lw 1.5 ps 0.6 pt (i % 6 + 4) lc rgb word(colors, (i - 1) % 8 + 1) \
      title (d == 1 && p == 1 ? word(scenes, i) : '')
  }
}
unset multiplot
)";
  return text;
}

void draw(const std::vector<SceneSurvey>& scenes, const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder.string(), failure.message(), "choose another --out");
  paper::write_file(folder, "precision.csv", plot_data(scenes));
  paper::write_file(folder, "precision.gp", plot_script(scenes));
  if (paper::have_gnuplot()) paper::run_gnuplot(folder, "precision.gp");
}

}  // namespace

int precision_command(const PrecisionArgs& args) {
  const traces::RecordOptions recorded = record_options(args.scene);
  PrecisionOptions options;
  options.config = load_config(args.unit.config_path, args.unit.sets);
  options.designs = parse_designs(args.designs);
  options.box_bits = parse_bits(args.box_bits);
  options.rays = args.rays;
  for (const cull::Design design : options.designs) require_possible(design, recorded.masks);
  std::vector<SceneSurvey> scenes;
  bool sound = true;
  print_header(args.markdown);
  for (const ListedScene& listed : listed_scenes(args.scene)) {
    const std::optional<scene::Scene> scene = load_listed(args.scene, listed);
    if (!scene) continue;
    Progress bar(listed.name, 0, "runs");
    scenes.push_back(
        {listed.name, survey_precision(*scene, recorded, options, [&](std::uint64_t done) { bar.update(done); })});
    print_rows(listed.name, scenes.back().survey, args.markdown);
    for (const PrecisionRun& run : scenes.back().survey.runs) sound &= run.lost_hits == 0;
  }
  if (!args.output.empty() && !scenes.empty()) draw(scenes, args.output);
  return sound ? 0 : 1;
}

}  // namespace ctu::sim
