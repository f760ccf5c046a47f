// Runs the timed unit over a feed of rays, in any execution mode; all end on the same cycle with the same event log.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/pipeline/result.h"
#include "model/pipeline/unit_config.h"
#include "model/reference/ray_block.h"

namespace ctu::pipeline {
class Timeline;
}

namespace ctu::unit {

enum class Mode : std::uint8_t {
  Plain,  ///< no SystemC: for sweeps in threads
  Batch,  ///< one SC_MODULE advances the pipeline many cycles per activation
  Cycle,  ///< one SystemC activation a cycle
  Pins,   ///< one SC_MODULE a stage, ready/valid signals between them
};
enum class Source : std::uint8_t {
  Replay,  ///< outcomes come from the recorded steps
  Exec,    ///< the stages compute them
};

/// What the unit works on. The image's layout decides node and triangle addresses; its masks are those the tester asks.
struct Workload {
  const accel::Image& image;
  const cull::MaskTester& tester;
  reference::RayFeed& rays;
};

struct RunOptions {
  Mode mode = Mode::Batch;
  Source source = Source::Replay;
  std::string waves_path{};                       ///< VCD of the window, when not empty
  std::uint64_t waves_first = 0, waves_last = 0;  ///< cycles, inclusive
  pipeline::Timeline* timeline = nullptr;         ///< filled with what happens in its window
  std::uint64_t stall_seed = 0;                   ///< not 0: every link refuses at random, for tests
  int stuck_link = -1;                            ///< this link never takes anything: a planted deadlock, for tests
  std::function<void(std::uint64_t rays_done)> progress{};
};

/// Thrown when nothing moves for `watchdog.cycles`: the text shows every link and stage. Exit code 3.
class Deadlock : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

pipeline::UnitResult run(const pipeline::UnitConfig& config, const Workload& workload, const RunOptions& options);

}  // namespace ctu::unit
