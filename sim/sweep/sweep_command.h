// `ctusim sweep`: what its subcommands are given and the functions that do them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ctu::sweep {

struct SweepArgs {
  std::string space;   ///< file
  std::string folder;  ///< of the results
  std::string on = "local";
  std::string engine;               ///< empty: as the space says; "slurm" is --on slurm
  int jobs = 0;                     ///< at a time; 0: one for each core
  double time_limit = 0;            ///< seconds of a point; 0: none
  std::string memory;               ///< of a point, "2G"; empty: no limit
  bool retry_failed = false;        ///< points that ended without a result run again
  bool list = false;                ///< plan: every point
  bool dry_run = false;             ///< slurm: scripts are written and shown, nothing is submitted
  bool no_wait = false;             ///< slurm: submitted, and no more
  std::uint64_t chunk = 0;          ///< slurm: points of a task; 0: as many as make a few hundred tasks
  int at_once = 0;                  ///< slurm: tasks at a time; 0: as many as the cluster lets run
  std::vector<std::string> sbatch;  ///< options that go to sbatch as they are
  std::string points;               ///< work: file with ids, a chunk in each line
  std::string part;                 ///< work: name of the file in parts/
  std::uint64_t task = 0;           ///< work: line of `points`
};

int sweep_run_command(const SweepArgs& args);
int sweep_plan_command(const SweepArgs& args);
int sweep_status_command(const SweepArgs& args);
int sweep_collect_command(const SweepArgs& args);
int sweep_work_command(const SweepArgs& args);

/// `ctusim sweep` and its options; `exit_code` is set when one of them was run.
void add_sweep(CLI::App& app, SweepArgs& args, int& exit_code);

}  // namespace ctu::sweep
