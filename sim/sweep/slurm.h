// The same points by job arrays of Slurm: a task of the array is `ctusim sweep work` on a chunk of points.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/sweep/folder.h"

namespace ctu::sweep {

struct SlurmOptions {
  std::uint64_t chunk = 0;               ///< points of a task; 0: as many as make 200 tasks at most
  int at_once = 0;                       ///< tasks at a time; 0: no limit of ours
  std::vector<std::string> sbatch;       ///< options for it, as they are
  std::vector<std::string> work_limits;  ///< options of `ctusim sweep work`
  bool dry_run = false, wait = true;
};

/// What array tasks are told: their script, the points of each, and the call of sbatch.
struct SlurmJob {
  int number = 0;                ///< of the folder's jobs; tasks append to parts/slurm-NUMBER-TASK.jsonl
  std::filesystem::path folder;  ///< slurm/NUMBER
  std::string script, chunks;
  std::vector<std::string> submit;
  std::uint64_t tasks = 0;
};
/// Throws Error when the chunks are more than an array may have.
SlurmJob make_job(const std::filesystem::path& sweep, int number, const std::string& program,
                  const std::vector<Point>& points, const SlurmOptions& options);

/// Points that are to be run still: asked again when tasks have ended.
using MissingPoints = std::function<std::vector<Point>()>;

/// Waits for arrays of this folder that are under way, submits what is missing, waits, and submits again what tasks
/// left (twice at most). Where tasks cannot be waited for, or are not to be, it returns before. Throws Error when
/// sbatch or squeue refuse.
void run_on_slurm(const SweepFolder& folder, const MissingPoints& missing, const SlurmOptions& options,
                  const std::function<bool()>& stop, const std::function<void(std::size_t missing)>& progress);

/// Throws Error when an array of the folder is under way: a local run would do its points twice.
void require_no_slurm_job(const SweepFolder& folder);

}  // namespace ctu::sweep
