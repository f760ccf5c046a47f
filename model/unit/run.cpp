#include "model/unit/run.h"

#include "model/pipeline/engine.h"
#include "model/unit/pins.h"
#include "model/unit/ticking.h"

namespace ctu::unit {
namespace {

pipeline::EngineOptions engine_options(const RunOptions& options) {
  pipeline::EngineOptions engine;
  engine.exec = options.source == Source::Exec;
  // The modes that tick every cycle do so in the pipeline too, so that they check the skipping of the others.
  engine.skip_idle = options.mode == Mode::Plain || options.mode == Mode::Batch;
  engine.backpressure = {options.stall_seed, options.stuck_link};
  engine.waves_path = options.waves_path;
  engine.waves_first = options.waves_first;
  engine.waves_last = options.waves_last;
  engine.timeline = options.timeline;
  engine.progress = options.progress;
  return engine;
}

pipeline::UnitResult run_mode(const pipeline::UnitConfig& config, const pipeline::Work& work,
                              const RunOptions& options) {
  if (options.mode == Mode::Pins) return run_pins(config, work, engine_options(options));
  const auto engine = pipeline::make_engine(config, work, engine_options(options));
  switch (options.mode) {
    case Mode::Batch:
      return run_ticking(*engine, static_cast<pipeline::Cycle>(config.unit.batch_cycles));
    case Mode::Cycle:
      return run_ticking(*engine, 1);
    default:
      return pipeline::run_to_end(*engine);
  }
}

}  // namespace

pipeline::UnitResult run(const pipeline::UnitConfig& config, const Workload& workload, const RunOptions& options) {
  try {
    return run_mode(config, {workload.image, workload.tester, workload.rays}, options);
  } catch (const pipeline::DeadlockFound& deadlock) {
    throw Deadlock(deadlock.what());
  }
}

}  // namespace ctu::unit
