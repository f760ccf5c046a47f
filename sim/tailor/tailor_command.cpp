// `ctusim tailor`: searches on samples, checks on all rays in the model and on some in gates, and says what was left
// out.
#include "sim/tailor/tailor_command.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/parallel.h"
#include "sim/config_file.h"
#include "sim/tailor/changes.h"
#include "sim/tailor/check.h"
#include "sim/tailor/search.h"
#include "sim/tailor/tailor_report.h"

namespace ctu::tailor {
namespace {

/// "1%", "0.5 %" or "1": a share of the cycles.
double parse_slowdown(const std::string& text) {
  double percent = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), percent);
  std::string rest(end, text.data() + text.size());
  std::erase(rest, ' ');
  if (error != std::errc() || (!rest.empty() && rest != "%") || !(percent >= 0 && percent <= 1000))
    throw Error("--slowdown", fmt::format("\"{}\" is not a share of the cycles", text), "write it as in 1% or 0.5%");
  return percent / 100;
}

void say(const std::string& line) { fmt::print(stderr, "{}\n", line); }

SearchOptions search_options(const TailorArgs& args, const std::vector<double>& ratios) {
  SearchOptions options;
  options.ratios = ratios;
  options.restarts = args.restarts;
  options.seed = args.seed;
  options.threads = args.threads == 0 ? available_threads() : args.threads;
  options.progress = say;
  return options;
}

bool within(const TailorResult& result) { return slowest_ratio(result.before, result.after) <= 1 + result.slowdown; }

/// Puts keys back, the one that gains most first, until all rays are fast enough.
void put_back(Workbench& bench, const pipeline::UnitConfig& start, TailorResult& result) {
  while (!within(result)) {
    const std::vector<Change> changes = changes_of(bench, start, result.config());
    const auto most = std::max_element(changes.begin(), changes.end(),
                                       [](const Change& a, const Change& b) { return a.gain < b.gain; });
    if (most == changes.end() || most->gain <= 0) {
      result.after = result.before;
      return;
    }
    say(fmt::format("{} is put back to {}", most->key, most->before));
    result.after = run_whole(bench, with_value(result.config(), most->key, value_of(start, most->key)));
  }
}

/// Searches until the whole traces are within the slowdown too: what the sample showed too small is allowed for.
TailorResult search_and_check(Workbench& bench, const pipeline::UnitConfig& start, const TailorArgs& args,
                              double slowdown) {
  constexpr int kAttempts = 3;
  TailorResult result;
  result.slowdown = slowdown;
  result.before = run_whole(bench, start);
  std::vector<double> ratios(bench.traces(), 1 + slowdown);
  for (int attempt = 1; attempt <= kAttempts; ++attempt) {
    const SearchResult found = find_smallest(bench, start, search_options(args, ratios));
    result.after = run_whole(bench, found.config);
    say(fmt::format("all rays: {:+.3f} % cycles on the trace that loses most",
                    100 * (slowest_ratio(result.before, result.after) - 1)));
    if (within(result)) return result;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      const double whole = cycles_ratio(result.before[i], result.after[i]);
      const double sample =
          static_cast<double>(bench.run(found.config).cycles[i]) / static_cast<double>(bench.run(start).cycles[i]);
      ratios[i] = std::min(ratios[i], (1 + slowdown) * sample / whole);
    }
  }
  put_back(bench, start, result);
  return result;
}

UnitParts parts_of_all(Workbench& bench, const pipeline::UnitConfig& config) {
  UnitParts parts = parts_of(bench.shape(0, config));
  for (std::size_t i = 1; i < bench.traces(); ++i)
    parts = joined(parts, parts_of(bench.shape(i, config)), bench.trace(i).reader().path());
  return parts;
}

std::string tailored_toml(const TailorResult& result) {
  std::string text = "# A unit tailored by ctusim to:\n";
  for (const sim::RunRecord& record : result.after)
    text += fmt::format("#   {} ({})\n", record.scene, record.trace_hash);
  text += fmt::format("# at most {:.3g} % slower on each than configuration {}.\n\n", 100 * result.slowdown,
                      result.before.front().config_hash);
  return text + sim::config_to_toml(result.config(), false) + "\n" + to_toml(result.parts);
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  if (!out.flush()) throw Error(path, "could not be written", "check the folder and the free space");
}

}  // namespace

int tailor_command(const TailorArgs& args) {
  const double slowdown = parse_slowdown(args.slowdown);
  const pipeline::UnitConfig start = sim::load_config(args.config_path, args.sets);
  for (const std::string& path : {args.output, args.json_path})
    if (!path.empty()) sim::check_writable(path);
  Workbench bench(args.traces, args.sample);
  TailorResult result = search_and_check(bench, start, args, slowdown);
  result.parts = parts_of_all(bench, result.config());
  result.changes = changes_of(bench, start, result.config());
  result.missing = missing_parts(result.parts, result.config());
  result.advice = advice(bench, result.config(), unread_rows(result.after));
  if (args.area) synthesise(result, start);
  if (args.gate_rays > 0)
    result.gates = check_gates(bench, result.config(), result.parts, args.gate_rays, args.build_rtl);
  args.markdown ? print_markdown(result) : print_report(result);
  const std::string toml = tailored_toml(result);
  if (args.output.empty())
    fmt::print("\n{}", toml);
  else
    write_text(args.output, toml);
  if (!args.json_path.empty()) write_text(args.json_path, report_json(result));
  return result.is_right() ? 0 : 1;
}

}  // namespace ctu::tailor
