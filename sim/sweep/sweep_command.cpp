// The commands of `ctusim sweep` that run points or look at what was run.
#include "sim/sweep/sweep_command.h"

#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "sim/sweep/collect.h"
#include "sim/sweep/expand.h"
#include "sim/sweep/result_store.h"
#include "sim/sweep/row.h"
#include "sim/sweep/search.h"
#include "sim/sweep/slurm.h"
#include "sim/sweep/stop_signal.h"
#include "sim/sweep/sweep_run.h"
#include "sim/sweep/trace_recorder.h"
#include "sim/sweep/worker.h"
#include "sim/unit_runner.h"

namespace ctu::sweep {
namespace {

constexpr std::size_t kListedFailures = 20;

Space space_of(const SweepArgs& args) {
  if (args.space.empty())
    throw Error("SPACE", "no file is named", "`ctusim sweep SPACE.toml -o DIR`; docs/sweeps.md shows a space");
  Space space = read_space(args.space);
  if (!args.engine.empty() && args.engine != "slurm") space.engine = args.engine;
  sim::require_engine(space.engine);
  return space;
}

std::vector<Candidate> candidates_of(const Space& space) {
  if (space.search.mode == SearchMode::Grid) return walk_grid(space).accepted;
  const Expander expander(space);
  return draw_candidates(CandidateSpace(space), space.search.points, space.search.seed, 0,
                         [&](const Candidate& candidate) { return expander.accepts(candidate); });
}

struct Tally {
  std::size_t done = 0, wrong = 0, failed = 0, missing = 0;
  std::map<std::string, std::size_t> statuses;
};

Tally tally_of(const std::vector<Point>& points, const StoredResults& results) {
  Tally tally;
  for (const Point& point : points) {
    const auto status = results.status_of.find(point.id);
    if (status == results.status_of.end()) {
      ++tally.missing;
      continue;
    }
    ++tally.statuses[status->second];
    if (status->second == kDone)
      ++tally.done;
    else
      ++(status->second == kWrong ? tally.wrong : tally.failed);
  }
  return tally;
}

void print_failures(const std::vector<Point>& points, const StoredResults& results) {
  std::size_t listed = 0;
  for (const Point& point : points) {
    const auto status = results.status_of.find(point.id);
    if (status == results.status_of.end() || status->second == kDone) continue;
    if (++listed > kListedFailures) continue;
    const auto row = nlohmann::json::parse(results.line_of.at(point.id));
    const std::string message = row.at("message");
    fmt::print("{}: {}\n  {}\n", status->second, message.substr(0, message.find('\n')), command_of(point));
  }
  if (listed > kListedFailures) fmt::print("... and {} more\n", listed - kListedFailures);
}

int print_status(const std::vector<Point>& points, const StoredResults& results) {
  const Tally tally = tally_of(points, results);
  std::string others;
  for (const auto& [status, count] : tally.statuses)
    if (status != kDone) others += fmt::format(", {} {}", count, status);
  fmt::print("{} points: {} done{}{}\n", points.size(), tally.done, others,
             tally.missing == 0 ? "" : fmt::format(", {} missing", tally.missing));
  print_failures(points, results);
  return tally.done == points.size() ? 0 : 1;
}

void print_axis(const Axis& axis) {
  std::string keys, values;
  for (const std::string& key : axis.keys) keys += (keys.empty() ? "" : ", ") + key;
  for (const auto& choice : axis.choices) {
    std::string words;
    for (const std::string& value : choice) words += (words.empty() ? "" : "/") + value;
    values += (values.empty() ? "" : " ") + words;
  }
  fmt::print("axis    {} values of {}: {}\n", axis.choices.size(), keys, values);
}

void print_candidate(const Expander& expander, const Candidate& candidate) {
  std::string words;
  for (const Setting& setting : expander.settings(candidate))
    words += fmt::format(" {}={}", setting.key, setting.value);
  fmt::print("{} traces with{}\n", expander.traces(candidate).size(), words.empty() ? " the base" : words);
}

}  // namespace

int sweep_plan_command(const SweepArgs& args) {
  const Space space = space_of(args);
  for (const TraceSource& trace : space.traces) {
    std::string words;
    for (const std::string& word : trace.record_words) words += " " + word;
    fmt::print("trace   {}{}\n", trace.name, words.empty() ? "" : ": ctusim" + words);
  }
  for (const Axis& axis : space.axes) print_axis(axis);
  std::vector<Candidate> candidates;
  if (space.search.mode == SearchMode::Grid) {
    const GridCount grid = walk_grid(space);
    candidates = grid.accepted;
    fmt::print("grid    {} configurations; {} excluded, {} that no unit can have{}\n", grid.candidates, grid.excluded,
               grid.refused, grid.first_refusal.empty() ? "" : fmt::format(" (the first: {})", grid.first_refusal));
  } else if (space.search.mode == SearchMode::Pareto) {
    fmt::print("search  {} generations of {} of {} configurations, as many at random beside them, seed {}\n",
               space.search.generations, space.search.population, CandidateSpace(space).count(), space.search.seed);
    return 0;
  } else {
    candidates = candidates_of(space);
    fmt::print("{}  {} of {} configurations, seed {}\n", to_string(space.search.mode), candidates.size(),
               CandidateSpace(space).count(), space.search.seed);
  }
  const Expander expander(space);
  std::uint64_t points = 0;
  for (const Candidate& candidate : candidates) points += expander.traces(candidate).size();
  fmt::print("points  {} with engine {}\n", points, space.engine);
  if (args.list)
    for (const Candidate& candidate : candidates) print_candidate(expander, candidate);
  if (!args.folder.empty()) {
    const SweepFolder folder(args.folder);
    const Tally tally = tally_of(folder.read_points(), read_results(folder));
    fmt::print("folder  {} points: {} done, {} failed, {} missing\n", args.folder,
               tally.done + tally.wrong + tally.failed + tally.missing, tally.done, tally.wrong + tally.failed,
               tally.missing);
  }
  return 0;
}

int sweep_run_command(const SweepArgs& args) {
  const Space space = space_of(args);
  if (args.folder.empty()) throw Error("-o", "no folder for the results", "`ctusim sweep SPACE.toml -o DIR`");
  require_runner(args);
  if (space.search.mode == SearchMode::Pareto && (args.no_wait || args.dry_run))
    throw Error("--no-wait, --dry-run", "a search must have results before it knows what to ask next",
                "leave them out");
  const SweepFolder folder(args.folder, true);
  const FolderLock lock(folder.path() / "lock");
  if (!is_on_slurm(args)) require_no_slurm_job(folder);
  const StopSignal signals;
  auto facts = ready_traces(space, folder, [] { return StopSignal::received(); });
  if (StopSignal::received()) return StopSignal::exit_code();
  folder.replace(folder.path() / "space.toml", space.text);
  SweepRun run(args, space, folder, std::move(facts));
  if (space.search.mode == SearchMode::Pareto)
    search(run);
  else
    run.run(candidates_of(space));
  if (args.dry_run) return 0;
  collect(folder);
  if (StopSignal::received()) fmt::print("stopped; the same command goes on\n");
  const int code = print_status(run.points(), run.results());
  if (StopSignal::received()) return StopSignal::exit_code();
  return args.no_wait && tally_of(run.points(), run.results()).missing != 0 ? 0 : code;
}

int sweep_status_command(const SweepArgs& args) {
  const SweepFolder folder(args.folder);
  const StoredResults results = read_results(folder);
  const int code = print_status(folder.read_points(), results);
  if (results.torn_parts != 0)
    fmt::print("{} files end within a line: its point counts as missing\n", results.torn_parts);
  return code;
}

int sweep_collect_command(const SweepArgs& args) {
  const SweepFolder folder(args.folder);
  const Table table = collect(folder);
  fmt::print("{}: {} rows of {} columns in results.jsonl, results.csv, results.sqlite; units in columns.csv\n",
             args.folder, table.rows.size(), table.columns.size());
  return 0;
}

int sweep_work_command(const SweepArgs& args) {
  const SweepFolder folder(args.folder);
  std::istringstream in(read_file(args.points, std::uint64_t{1} << 30, "`ctusim sweep run --on slurm` writes it"));
  std::string line;
  for (std::uint64_t number = 0; number <= args.task; ++number)
    if (!std::getline(in, line))
      throw Error(args.points, fmt::format("has no line {}", args.task), "lines are counted from 0");
  std::istringstream words(line);
  std::set<std::string> wanted;
  for (std::string id; words >> id;) wanted.insert(id);
  const StoredResults results = read_results(folder);
  std::vector<Point> points;
  for (Point& point : folder.read_points())
    if (wanted.count(point.id) != 0 && !results.has_result(point.id)) points.push_back(std::move(point));
  const StopSignal signals;
  const WorkReport report = run_points(
      folder, points, args.part, limits_of(args), [] { return StopSignal::received(); }, [](std::size_t) {});
  fmt::print("{} of {} points ended, {} of them without a right result\n", report.done, points.size(), report.failed);
  return StopSignal::received() ? StopSignal::exit_code() : report.done == points.size() ? 0 : 1;
}

}  // namespace ctu::sweep
