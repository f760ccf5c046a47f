// Results as they were appended: parts/*.jsonl of a sweep's folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/sweep/durable.h"
#include "sim/sweep/folder.h"

namespace ctu::sweep {

/// One writer's file. Its lock goes with it.
class PartWriter {
 public:
  /// parts/NAME.jsonl; what a write left that did not come to its end is cut off, and said on stderr.
  PartWriter(const SweepFolder& folder, const std::string& name);
  /// Syncs what was not yet.
  ~PartWriter();
  /// With the system when it returns, so that no end of this process loses it; on the disk within a quarter of a second
  /// of further rows, or at the end. `timing` as well, but not before `row`.
  void append(const std::string& row, const std::string& timing);

 private:
  FolderLock lock_;
  std::uint64_t cut_bytes_;
  DurableFile rows_, timings_;
  std::chrono::steady_clock::time_point last_sync_{};
};

struct StoredResults {
  std::map<std::string, std::string> line_of;    ///< by id: the one that counts
  std::map<std::string, std::string> status_of;  ///< by id
  std::uint64_t lines = 0;
  std::uint64_t repeated = 0;    ///< lines of an id that was there already, equal to it or in the place of a failure
  std::uint64_t torn_parts = 0;  ///< files that end within a line, which is left out

  bool has(const std::string& id) const { return line_of.count(id) != 0; }
  bool has_result(const std::string& id) const;
};

/// All parts, by name. Of several lines of an id a result counts before a failure, and a later line before an earlier.
/// Throws Error when two results of one id differ: a run is not repeatable, or parts of different versions are mixed.
StoredResults read_results(const SweepFolder& folder);

}  // namespace ctu::sweep
