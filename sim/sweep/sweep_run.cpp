#include "sim/sweep/sweep_run.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/parallel.h"
#include "sim/progress.h"
#include "sim/sweep/slurm.h"
#include "sim/sweep/stop_signal.h"
#include "sim/sweep/worker.h"

namespace ctu::sweep {
namespace {

std::uint64_t parse_bytes(const std::string& text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(end, text.data() + text.size());
  const std::map<std::string, int> shifts = {{"", 0}, {"K", 10}, {"M", 20}, {"G", 30}};
  const auto shift = shifts.find(unit);
  if (error != std::errc() || shift == shifts.end() || number == 0 || number >> (63 - shift->second) != 0)
    throw Error("--memory", fmt::format("\"{}\" is no amount of memory", text), "write it as in 2G, 500M or 100000K");
  return number << shift->second;
}

SlurmOptions slurm_options(const SweepArgs& args) {
  SlurmOptions options;
  options.chunk = args.chunk;
  options.at_once = args.at_once;
  options.sbatch = args.sbatch;
  options.dry_run = args.dry_run;
  options.wait = !args.no_wait;
  if (args.time_limit > 0) options.work_limits = {"--time-limit", fmt::format("{}", args.time_limit)};
  if (!args.memory.empty()) options.work_limits.insert(options.work_limits.end(), {"--memory", args.memory});
  return options;
}

}  // namespace

PoolLimits limits_of(const SweepArgs& args) {
  PoolLimits limits;
  limits.jobs = args.jobs == 0 ? available_threads() : args.jobs;
  limits.seconds = args.time_limit;
  if (!args.memory.empty()) limits.bytes = parse_bytes(args.memory);
  return limits;
}

bool is_on_slurm(const SweepArgs& args) { return args.on == "slurm" || args.engine == "slurm"; }

void require_runner(const SweepArgs& args) {
  if (args.on != "local" && args.on != "slurm")
    throw Error("--on", fmt::format("\"{}\" is no place to run", args.on), "give local or slurm");
  if (!is_on_slurm(args) &&
      (args.dry_run || args.no_wait || args.chunk != 0 || args.at_once != 0 || !args.sbatch.empty()))
    throw Error("--chunk, --at-once, --sbatch, --dry-run, --no-wait", "are for Slurm", "add --on slurm");
  limits_of(args);
}

SweepRun::SweepRun(const SweepArgs& args, const Space& space, const SweepFolder& folder, std::vector<TraceFacts> facts)
    : args_(args), space_(space), folder_(folder), expander_(space), facts_(std::move(facts)) {}

/// A trace's points together, so that few traces are loaded at a time; the same configuration twice is one point.
void SweepRun::plan(const std::vector<Candidate>& candidates) {
  std::vector<Point> points;
  for (const Candidate& candidate : candidates)
    for (Point& point : points_of(candidate))
      if (planned_.insert(point.id).second) points.push_back(std::move(point));
  std::map<std::string, std::size_t> place;
  for (const TraceFacts& trace : facts_) place.emplace(trace.name, place.size());
  std::stable_sort(points.begin(), points.end(),
                   [&](const Point& a, const Point& b) { return place[a.trace.name] < place[b.trace.name]; });
  points_.insert(points_.end(), std::make_move_iterator(points.begin()), std::make_move_iterator(points.end()));
  if (points_.empty()) throw Error(space_.path, "leaves no point to run", "`ctusim sweep plan` says what was left out");
  folder_.write_points(points_);
}

std::vector<Point> SweepRun::missing(const StoredResults& results, bool retry_failed) const {
  std::vector<Point> missing;
  for (const Point& point : points_)
    if (!results.has(point.id) || (retry_failed && !results.has_result(point.id))) missing.push_back(point);
  return missing;
}

void SweepRun::run_missing() {
  const std::vector<Point> points = missing(results_, args_.retry_failed);
  const auto stop = [] { return StopSignal::received(); };
  sim::Progress bar("sweep", points.size(), "points");
  if (!is_on_slurm(args_)) {
    run_points(folder_, points, "local", limits_of(args_), stop, [&](std::size_t done) { bar.update(done); });
    return;
  }
  // A failure that this run has seen is not tried again by it.
  bool first = true;
  const auto still_missing = [&] {
    const bool again = std::exchange(first, false) && args_.retry_failed;
    return missing(read_results(folder_), again);
  };
  run_on_slurm(folder_, still_missing, slurm_options(args_), stop,
               [&](std::size_t left) { bar.update(points.size() - std::min(left, points.size())); });
}

void SweepRun::run(const std::vector<Candidate>& candidates) {
  const std::size_t before = points_.size();
  plan(candidates);
  results_ = read_results(folder_);
  const auto known = std::count_if(points_.begin() + static_cast<std::ptrdiff_t>(before), points_.end(),
                                   [&](const Point& point) { return results_.has(point.id); });
  if (known != 0) fmt::print("{} of {} points are there already\n", known, points_.size() - before);
  run_missing();
  results_ = read_results(folder_);
}

}  // namespace ctu::sweep
