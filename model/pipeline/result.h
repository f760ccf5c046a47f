// What a run of the timed unit reports. Every cycle of every stage is accounted for (contract 4).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/intersect/ray.h"
#include "model/reference/step.h"

namespace ctu::pipeline {

struct Cause {
  std::string name;  ///< "output_full", "bank_conflict", "mshr_full", ...
  std::string description;
  std::uint64_t cycles = 0;
};

/// busy + sum(stalled) + idle = cycles of the run, for each stage.
struct StageAccount {
  std::string stage;
  std::uint64_t busy = 0, idle = 0;
  std::vector<Cause> stalled;
};

struct Counter {
  std::string name, unit, description;
  std::uint64_t value = 0;
};

/// A ray whose returned hit is not the expected one, bit for bit.
struct WrongHit {
  std::uint64_t ray = 0;
  intersect::Hit expected, returned;
};

struct UnitResult {
  std::uint64_t cycles = 0;
  std::uint64_t rays = 0;  ///< returned and checked
  std::uint64_t wrong_hits = 0;
  std::vector<WrongHit> first_wrong;  ///< up to 16
  std::uint64_t other_visits = 0;     ///< exec: visits that are not the recorded ones; replay follows these
  reference::Counts counts;           ///< as the unit counted them
  std::vector<StageAccount> stages;
  std::vector<Counter> counters;      ///< cache, memory, tables, stack, queues
  std::vector<Cause> ray_cycles;      ///< where rays spent their time; sums to ray_latency_sum
  std::uint64_t ray_latency_sum = 0;  ///< cycles from a ray's entry into its context to its return, summed over rays
  std::vector<std::string> left_out;  ///< stages and tables this run does not need, and what that saved (contract 5)
  /// Over (cycle, ray, step) of every visit and return: equal in every execution mode.
  std::uint64_t event_log_hash = 0;

  /// None where the unit has no such counter.
  std::optional<std::uint64_t> counter(std::string_view name) const {
    for (const Counter& one : counters)
      if (one.name == name) return one.value;
    return std::nullopt;
  }
};

}  // namespace ctu::pipeline
