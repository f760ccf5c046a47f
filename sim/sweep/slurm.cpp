#include "sim/sweep/slurm.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/sweep/shell.h"

namespace ctu::sweep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJobId = "job-id";       // the array's number, once it is submitted
constexpr const char* kFinished = "finished";  // no task of it is queued or runs any more

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> job_folders(const SweepFolder& folder) {
  std::vector<fs::path> jobs;
  if (fs::exists(folder.path() / "slurm"))
    for (const auto& entry : fs::directory_iterator(folder.path() / "slurm"))
      if (fs::exists(entry.path() / kJobId)) jobs.push_back(entry.path());
  std::sort(jobs.begin(), jobs.end());
  return jobs;
}

int next_number(const SweepFolder& folder) {
  int number = 0;
  while (fs::exists(folder.path() / "slurm" / std::to_string(number))) ++number;
  return number;
}

/// Whether a task of the array waits or runs. Nothing when squeue cannot say.
std::optional<bool> is_under_way(const std::string& id) {
  const ShellOutcome queue = run_shell({"squeue", "--noheader", "--array", "--jobs=" + id, "--format=%i"});
  if (queue.exit_code == 0) return queue.out.find(id) != std::string::npos;
  if (queue.out.find("Invalid job id") != std::string::npos) return false;  // forgotten: it has ended long ago
  return std::nullopt;
}

[[noreturn]] void refuse_squeue(const std::string& id) {
  throw Error("squeue", fmt::format("does not say whether job {} has ended", id),
              "mend the way to the cluster; the same command goes on where it was");
}

/// Until no task is queued or runs. False when told to stop.
bool wait_for(const SweepFolder& folder, const fs::path& job, const std::function<bool()>& stop,
              const std::function<void()>& look) {
  // Soon at first, for short arrays, then seldom, for the controller's sake.
  constexpr auto kPause = std::chrono::milliseconds(100);
  constexpr int kMostPauses = 50;
  constexpr int kMostSilence = 60;  // questions without an answer
  int pauses = 3;
  const std::string id = text_of(job / kJobId);
  for (int silence = 0; silence < kMostSilence;) {
    const auto answer = is_under_way(id);
    if (answer && !*answer) {
      folder.write_atomically(job / kFinished, "");
      return true;
    }
    silence = answer ? 0 : silence + 1;
    look();
    pauses = std::min(pauses + 1, kMostPauses);
    for (int i = 0; i < pauses; ++i) {
      if (stop()) return false;
      std::this_thread::sleep_for(kPause);
    }
  }
  refuse_squeue(id);
}

void submit(const SweepFolder& folder, const SlurmJob& job) {
  const ShellOutcome outcome = run_shell(job.submit);
  const std::string id = outcome.out.substr(0, outcome.out.find_first_not_of("0123456789"));
  if (outcome.exit_code == 127) throw Error("sbatch", "is not there", "run it where Slurm is, or take --on local");
  if (outcome.exit_code != 0 || id.empty())
    throw Error("sbatch", outcome.out.substr(0, outcome.out.find_last_not_of('\n') + 1),
                "mend the options behind --sbatch; --dry-run shows the whole call");
  folder.write_atomically(job.folder / kJobId, id);
  fmt::print("submitted job {}: {} tasks\n", id, job.tasks);
  std::fflush(stdout);
}

}  // namespace

SlurmJob make_job(const fs::path& sweep, int number, const std::string& program, const std::vector<Point>& points,
                  const SlurmOptions& options) {
  constexpr std::uint64_t kUsualTasks = 200, kMostTasks = 1000;  // Slurm's own limit is 1001 unless it is configured
  SlurmJob job;
  job.number = number;
  job.folder = sweep / "slurm" / std::to_string(number);
  const std::uint64_t chunk = options.chunk != 0 ? options.chunk : (points.size() + kUsualTasks - 1) / kUsualTasks;
  job.tasks = (points.size() + chunk - 1) / chunk;
  if (job.tasks > kMostTasks)
    throw Error("--chunk",
                fmt::format("{} points make {} tasks of {}, an array has {} at most", points.size(), job.tasks, chunk,
                            kMostTasks),
                fmt::format("give {} or more", (points.size() + kMostTasks - 1) / kMostTasks));
  for (std::size_t i = 0; i < points.size(); ++i) {
    job.chunks += points[i].id;
    job.chunks += (i + 1) % chunk == 0 || i + 1 == points.size() ? "\n" : " ";
  }
  std::vector<std::string> work = {program,        "sweep",    "work",
                                   sweep.string(), "--points", (job.folder / "chunks").string()};
  work.insert(work.end(), options.work_limits.begin(), options.work_limits.end());
  job.script = "#!/bin/sh\n# A task of the array runs one line of `chunks`.\nexec " + quoted(work) +
               " --jobs \"${SLURM_CPUS_PER_TASK:-1}\" --task \"$SLURM_ARRAY_TASK_ID\" --part \"slurm-" +
               std::to_string(number) + "-$SLURM_ARRAY_TASK_ID\"\n";
  job.submit = {"sbatch", "--parsable", "--job-name=ctusim-sweep",
                fmt::format("--array=0-{}{}", job.tasks - 1,
                            options.at_once > 0 ? fmt::format("%{}", options.at_once) : std::string()),
                "--output=" + (job.folder / "%a.log").string()};
  job.submit.insert(job.submit.end(), options.sbatch.begin(), options.sbatch.end());
  job.submit.push_back((job.folder / "script").string());
  return job;
}

void require_no_slurm_job(const SweepFolder& folder) {
  for (const fs::path& job : job_folders(folder)) {
    if (fs::exists(job / kFinished)) continue;
    const std::string id = text_of(job / kJobId);
    const auto answer = is_under_way(id);
    if (!answer) refuse_squeue(id);
    if (*answer)
      throw Error(folder.path().string(), fmt::format("Slurm's job {} works at this sweep", id),
                  fmt::format("wait for it with --on slurm, or end it with scancel {}", id));
    folder.write_atomically(job / kFinished, "");
  }
}

void run_on_slurm(const SweepFolder& folder, const MissingPoints& missing, const SlurmOptions& options,
                  const std::function<bool()>& stop, const std::function<void(std::size_t)>& progress) {
  constexpr int kMostTries = 3;
  const auto look = [&] { progress(missing().size()); };
  if (!options.dry_run)
    for (const fs::path& job : job_folders(folder))
      if (!fs::exists(job / kFinished)) {
        fmt::print("job {} is under way\n", text_of(job / kJobId));
        if (!options.wait || !wait_for(folder, job, stop, look)) return;
      }
  const fs::path sweep = fs::absolute(folder.path());
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  for (int tries = 0; tries < kMostTries; ++tries) {
    const std::vector<Point> points = missing();
    if (points.empty()) return;
    if (tries != 0) fmt::print("tasks left {} points\n", points.size());
    const SlurmJob job = make_job(sweep, next_number(folder), program, points, options);
    if (options.dry_run) {
      fmt::print("{}\n\n{}", quoted(job.submit), job.script);
      return;
    }
    fs::create_directories(job.folder);
    folder.write_atomically(job.folder / "chunks", job.chunks);
    folder.write_atomically(job.folder / "script", job.script);
    submit(folder, job);
    if (!options.wait || !wait_for(folder, job.folder, stop, look)) return;
  }
}

}  // namespace ctu::sweep
