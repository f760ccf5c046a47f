// SystemC's stages and the RTL side by side: every handshake of every link and the account of every stage, in every
// cycle.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "model/pipeline/backpressure.h"
#include "model/pipeline/result.h"
#include "model/pipeline/work.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

/// The first thing in which the twins differ.
struct Difference {
  pipeline::Cycle cycle = 0;
  std::string module;  ///< link or stage
  std::string port;    ///< "valid", "ready", "pop", "push", "data", "activity"
  std::string model, rtl;
  std::optional<std::uint64_t> ray;  ///< the one whose token it is
  std::uint32_t step = 0;            ///< its visit under way, by its number in the recorded sequence
};
/// In one line for people.
std::string to_string(const Difference& difference);

struct LockStepOptions {
  std::uint64_t stall_seed = 0;  ///< not 0: every link refuses at random
  std::string waves_prefix;      ///< not empty: PREFIX.model.vcd and PREFIX.rtl.vcd of the window, differences or not
  pipeline::Cycle waves_first = 0, waves_last = 0;
  std::function<void(std::uint64_t rays_done)> progress{};
};

struct LockStepResult {
  pipeline::UnitResult model;  ///< of the model's side
  std::uint64_t rtl_wrong_hits = 0;
  std::uint64_t cycles = 0;
  std::uint64_t handshakes = 0;  ///< tokens compared as they were pushed
  std::uint64_t compared = 0;    ///< signals compared: all links and stages in all cycles
  std::optional<Difference> difference;
};

/// Runs until the end or the first difference. Both sides need a feed of their own over the same rays. Throws Error
/// where the build cannot run this; pipeline::DeadlockFound when the model's watchdog would bark.
LockStepResult run_lock_step(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& model_work,
                             const pipeline::Work& rtl_work, const LockStepOptions& options);

}  // namespace ctu::cosim
