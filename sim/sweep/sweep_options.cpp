// add_sweep: the options of `ctusim sweep` and its subcommands.
#include <CLI/CLI.hpp>

#include "sim/sweep/sweep_command.h"

namespace ctu::sweep {
namespace {

void add_limits(CLI::App& app, SweepArgs& args) {
  app.add_option("-j,--jobs", args.jobs, "points at a time; 0: one for each core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--time-limit", args.time_limit, "seconds that a point may take; 0: no limit")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--memory", args.memory, "that a point may take beside its trace, as in 2G or 500M; none: no limit");
}

void add_run_options(CLI::App& app, SweepArgs& args) {
  app.add_option("space", args.space, "TOML file: traces, axes, what to leave out, how to search");
  app.add_option("-o,--output", args.folder, "folder of the results; what it holds already is not run again");
  app.add_option("--on", args.on, "local: processes on this machine; slurm: job arrays on a cluster")
      ->capture_default_str();
  app.add_option("--engine", args.engine,
                 "instead of the space's: cycle, reference, rtl, ...; slurm is short for --on slurm");
  add_limits(app, args);
  app.add_flag("--retry-failed", args.retry_failed, "points that ended without a result run again");
  app.add_option("--chunk", args.chunk, "slurm: points of a task; 0: as many as make at most 200 tasks")
      ->capture_default_str();
  app.add_option("--at-once", args.at_once, "slurm: tasks that run at a time; 0: as many as the cluster lets")
      ->capture_default_str();
  app.add_option("--sbatch", args.sbatch,
                 "slurm: an option for sbatch, as in --sbatch=--partition=long; may be repeated")
      ->expected(1)
      ->take_all();
  app.add_flag("--dry-run", args.dry_run, "slurm: write and show what would be submitted, and submit nothing");
  app.add_flag("--no-wait", args.no_wait, "slurm: return when it is submitted; the same command later goes on");
}

}  // namespace

void add_sweep(CLI::App& app, SweepArgs& args, int& exit_code) {
  auto* sweep = app.add_subcommand(
      "sweep", "many configurations on many traces: `sweep SPACE.toml -o DIR`, or one of the commands below");
  sweep->require_subcommand(0, 1);
  add_run_options(*sweep, args);
  sweep->callback([&, sweep] {
    if (sweep->get_subcommands().empty()) exit_code = sweep_run_command(args);
  });
  auto* run = sweep->add_subcommand("run", "run what the folder does not hold yet");
  add_run_options(*run, args);
  run->callback([&] { exit_code = sweep_run_command(args); });

  auto* plan = sweep->add_subcommand("plan", "how many points a space has; runs nothing");
  plan->add_option("space", args.space, "TOML file")->required();
  plan->add_option("-o,--output", args.folder, "folder whose points count as done");
  plan->add_flag("--list", args.list, "print every configuration");
  plan->callback([&] { exit_code = sweep_plan_command(args); });

  auto* status = sweep->add_subcommand("status", "what is done, what failed and why, what is missing");
  status->add_option("folder", args.folder, "of the results")->required();
  status->callback([&] { exit_code = sweep_status_command(args); });

  auto* collect = sweep->add_subcommand("collect", "write results.jsonl, results.csv and results.sqlite");
  collect->add_option("folder", args.folder, "of the results")->required();
  collect->callback([&] { exit_code = sweep_collect_command(args); });

  auto* work = sweep->add_subcommand("work", "run one chunk of points: what a task of a job array does");
  work->add_option("folder", args.folder, "of the results")->required();
  work->add_option("--points", args.points, "file with the ids of a chunk in each line")->required();
  work->add_option("--task", args.task, "line of it, from 0")->required();
  work->add_option("--part", args.part, "name of the file in parts/ to append to")->required();
  add_limits(*work, args);
  work->callback([&] { exit_code = sweep_work_command(args); });
}

}  // namespace ctu::sweep
