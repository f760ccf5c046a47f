// Reads a Kanata log back as its grammar says (version 0004), and fails the test on whatever is not in it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ctu::test {

struct KanataStage {
  std::string name;
  std::uint64_t begin = 0, end = 0;
  bool ended = false;
};

struct KanataOp {
  std::uint64_t ray = 0, thread = 0;
  std::string label, detail;
  std::vector<KanataStage> stages;
  std::vector<std::size_t> producers;
  std::uint64_t begin = 0, end = 0;
  bool retired = false, flushed = false;
};

struct KanataLog {
  std::uint64_t first_cycle = 0, last_cycle = 0;
  std::vector<KanataOp> ops;
};

/// Cycles are those of the run. What has not ended is ended with the log.
KanataLog read_kanata(const std::string& text);

}  // namespace ctu::test
