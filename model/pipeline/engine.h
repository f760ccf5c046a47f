// The unit in plain C++, advanced cycle by cycle; what every execution but pins runs.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "model/accel/child_ref.h"
#include "model/pipeline/backpressure.h"
#include "model/pipeline/cycle.h"
#include "model/pipeline/event_log.h"
#include "model/pipeline/result.h"
#include "model/pipeline/timeline.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/work.h"

namespace ctu::pipeline {

/// Nothing moved for `watchdog.cycles`: the text shows the oldest ray, every link and every stage.
class DeadlockFound : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct EngineOptions {
  bool exec = false;           ///< compute outcomes; false: replay recorded ones
  bool skip_idle = true;       ///< jump over cycles in which nothing can move
  bool reverse_order = false;  ///< step the stages from the last to the first: the same result, for tests
  bool keep_events = false;    ///< the event log keeps its events, for tests
  Backpressure backpressure{};
  std::string waves_path{};
  Cycle waves_first = 0, waves_last = 0;
  Timeline* timeline = nullptr;  ///< filled with what happens in its window
  std::function<void(std::uint64_t rays_done)> progress{};
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// Runs until cycle `until` or until every ray has been returned; whether that is so. Throws DeadlockFound.
  virtual bool advance(Cycle until) = 0;
  /// Cycles done so far.
  virtual Cycle now() const = 0;
  /// Contexts that hold a ray.
  virtual int occupied_contexts() const = 0;
  virtual const EventLog& log() const = 0;
  /// Brings the caches up to date with a visit of a node or leaf that is not simulated; takes no time.
  virtual void warm(accel::ChildRef ref) = 0;
  virtual UnitResult result() = 0;
};

/// Throws Error on a configuration or work that cannot be.
std::unique_ptr<Engine> make_engine(const UnitConfig& config, const Work& work, const EngineOptions& options);

/// Advances to the end.
UnitResult run_to_end(Engine& engine);

}  // namespace ctu::pipeline
