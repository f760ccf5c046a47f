// What answers a scene's rays: the reference, the unit cycle by cycle, the unit in gates.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/check/check_scene.h"

namespace ctu::sim::check {

/// A ray whose answer is not, bit for bit, the reference's.
struct Difference {
  std::uint32_t ray = 0;
  std::string what;
};

struct Answers {
  std::vector<intersect::Hit> hits;     ///< by ray
  std::vector<Difference> differences;  ///< those that are known by ray
  std::uint64_t other_differences = 0;  ///< wrong answers beyond these, and visits that are not the reference's
};

/// One thread's execution.
class Execution {
 public:
  virtual ~Execution() = default;
  /// `random`: for what must not change an answer, as the unit's timing.
  virtual Answers run(const CheckScene& scene, CaseRandom& random) = 0;
};

using MakeExecution = std::function<std::unique_ptr<Execution>()>;

/// The untimed traversal.
std::unique_ptr<Execution> make_reference_execution();

}  // namespace ctu::sim::check
