// The folder of a sweep: what lies where, and the lock that keeps two runs out of it.
//
//   space.toml       the space as it was run last
//   points.jsonl     its points, in their order
//   traces/          what was recorded for it
//   parts/*.jsonl    results as they come, a line each: the truth; *.timings.jsonl beside them
//   results.*        what `collect` makes of both
//   slurm/           scripts, lists of points and logs of job arrays
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/sweep/point.h"

namespace ctu::sweep {

class SweepFolder {
 public:
  /// Must exist; `create`: made if it does not.
  explicit SweepFolder(const std::filesystem::path& path, bool create = false);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path points_file() const { return path_ / "points.jsonl"; }
  std::filesystem::path parts() const { return path_ / "parts"; }
  std::filesystem::path traces() const { return path_ / "traces"; }

  /// Whole or not at all, and on the disk when it returns.
  void write_atomically(const std::filesystem::path& file, const std::string& text) const;
  /// Whole or not at all, for what can be made again: after a power cut it may be as it was before.
  void replace(const std::filesystem::path& file, const std::string& text) const;
  void write_points(const std::vector<Point>& points) const;
  /// Error when there are none: nothing was run here.
  std::vector<Point> read_points() const;

 private:
  std::filesystem::path path_;
};

/// Held while it lives; it goes with the process, whatever ends that.
class FolderLock {
 public:
  /// Throws Error when another process holds it, naming that.
  explicit FolderLock(const std::filesystem::path& file);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace ctu::sweep
