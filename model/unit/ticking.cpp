#include "model/unit/ticking.h"

#include <exception>

#include "model/unit/simulation.h"

namespace ctu::unit {
namespace {

/// The pipeline as a module with its own event: an sc_clock would cost more than a pipeline cycle.
class PipelineModule : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(PipelineModule);
  PipelineModule(sc_core::sc_module_name name, pipeline::Engine& engine, pipeline::Cycle cycles)
      : sc_core::sc_module(name), engine_(engine), cycles_(cycles) {
    SC_METHOD(activate);
    sensitive << tick_;
  }

  /// What the pipeline threw, or null. The kernel must not see exceptions.
  std::exception_ptr failure() const { return failure_; }

 private:
  void activate() {
    try {
      const pipeline::Cycle before = engine_.now();
      if (engine_.advance(before + cycles_)) {
        sc_core::sc_pause();
        return;
      }
      tick_.notify(sc_core::sc_time(static_cast<double>(engine_.now() - before), sc_core::SC_NS));
    } catch (...) {
      failure_ = std::current_exception();
      sc_core::sc_pause();
    }
  }

  pipeline::Engine& engine_;
  pipeline::Cycle cycles_;
  sc_core::sc_event tick_;
  std::exception_ptr failure_;
};

}  // namespace

pipeline::UnitResult run_ticking(pipeline::Engine& engine, pipeline::Cycle cycles_per_activation) {
  const Simulation simulation;
  std::exception_ptr failure;
  {
    PipelineModule unit("ctu", engine, cycles_per_activation);
    sc_core::sc_start();
    failure = unit.failure();
  }
  if (failure) std::rethrow_exception(failure);
  return engine.result();
}

}  // namespace ctu::unit
