#include "model/unit/pins.h"

#include <memory>

#include "model/pipeline/connections.h"
#include "model/pipeline/deadlock_report.h"
#include "model/pipeline/exec_source.h"
#include "model/pipeline/parameter.h"
#include "model/pipeline/replay_source.h"
#include "model/pipeline/report.h"
#include "model/pipeline/wave_writer.h"
#include "model/unit/pin_wiring.h"
#include "model/unit/simulation.h"

namespace ctu::unit {
namespace {

using pipeline::EngineOptions;

/// Ends cycles: looks, at each rising edge, at what the cycle before has done. Signals still show that cycle then, as
/// links write in the same delta cycle.
class Watcher : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Watcher);
  Watcher(const sc_core::sc_module_name& name, PinShared& shared, std::function<bool()> end_of_cycle)
      : sc_core::sc_module(name), shared_(shared), end_of_cycle_(std::move(end_of_cycle)) {
    SC_METHOD(edge);
    dont_initialize();
    sensitive << shared_.clock.posedge_event();
  }

 private:
  void edge() {
    if (!started_) {
      started_ = true;
      return;
    }
    try {
      if (!shared_.failure && !end_of_cycle_()) {
        ++shared_.now;
        shared_.moved = false;
        return;
      }
    } catch (...) {
      shared_.failure = std::current_exception();
    }
    sc_core::sc_pause();
  }

  PinShared& shared_;
  std::function<bool()> end_of_cycle_;
  bool started_ = false;
};

template <class Source>
class PinUnit {
 public:
  PinUnit(const pipeline::UnitConfig& config, const pipeline::Work& work, const EngineOptions& options)
      : state_(config, work, options.timeline != nullptr && options.timeline->wants(0)),
        clock_("clock", 1, sc_core::SC_NS),
        shared_(clock_),
        stages_(construct(options), work.rays),
        watcher_("watcher", shared_, [this] { return end_of_cycle(); }),
        watchdog_(static_cast<Cycle>(config.watchdog.cycles)),
        timeline_(options.timeline),
        progress_(options.progress) {
    for_each_link(stages_, state_.has_spills, [&](const char* name, auto& out, auto& in) { join(name, out, in); });
    for_each_stage(stages_, [&](auto& stage) { probes_.stages.push_back(&stage.account); });
    if (!options.waves_path.empty())
      waves_ =
          std::make_unique<pipeline::WaveWriter>(options.waves_path, probes_, options.waves_first, options.waves_last);
  }

  pipeline::UnitResult run() {
    Cycle end = 0;
    if (!all_returned(stages_)) {
      sc_core::sc_start();
      if (shared_.failure) std::rethrow_exception(shared_.failure);
      end = shared_.now + 1;
    }
    if (waves_ != nullptr) waves_->close();
    if (timeline_ != nullptr) timeline_->close(end, state_.log);
    return make_result(state_, stages_, end);
  }

 private:
  pipeline::UnitState<Source>& construct(const EngineOptions& options) {
    shared_.backpressure = options.backpressure;
    PinConstruction::current().shared = &shared_;
    return state_;
  }

  template <class T>
  void join(const char* name, PinWiring::Out<T>& out, PinWiring::In<T>& in) {
    auto link = std::make_shared<LinkModule<T>>(name, shared_);
    link->bind(out, in);
    out.number = in.number = static_cast<int>(probes_.links.size());
    probes_.links.push_back({name, [&in](Cycle now) { return in.can_pop(now); },
                             [&out](Cycle now) { return out.can_push(now); },
                             [raw = link.get()] { return raw->occupancy(); }});
    links_.push_back(std::move(link));
  }

  /// Whether the run is over.
  bool end_of_cycle() {
    const Cycle now = shared_.now;
    if (waves_ != nullptr && waves_->wants(now)) {
      waves_->sample_links(now);
      waves_->sample_stages(now);
    }
    if (timeline_ != nullptr && timeline_->wants(now)) {
      timeline_->sample_links(probes_, now);
      timeline_->sample(probes_, state_.contexts, now);
    }
    if (timeline_ != nullptr) state_.log.keep_events(timeline_->wants(now + 1));
    if (shared_.moved) {
      last_moved_ = now;
    } else if (now - last_moved_ >= watchdog_) {
      throw pipeline::DeadlockFound(deadlock_report(now, last_moved_, probes_, state_.contexts));
    }
    const std::uint64_t done = PinWiring::stage(stages_.result_queue).rays();
    if (progress_ && done >= progress_due_) {
      progress_(done);
      progress_due_ = done + kProgressRays;
    }
    return all_returned(stages_);
  }

  static constexpr std::uint64_t kProgressRays = 256;

  pipeline::UnitState<Source> state_;
  sc_core::sc_clock clock_;
  PinShared shared_;
  pipeline::Stages<Source, PinWiring> stages_;
  std::vector<std::shared_ptr<void>> links_;
  Watcher watcher_;
  pipeline::Probes probes_;
  std::unique_ptr<pipeline::WaveWriter> waves_;
  Cycle watchdog_, last_moved_ = 0;
  pipeline::Timeline* timeline_;
  std::function<void(std::uint64_t)> progress_;
  std::uint64_t progress_due_ = kProgressRays;
};

}  // namespace

pipeline::UnitResult run_pins(const pipeline::UnitConfig& config, const pipeline::Work& work,
                              const EngineOptions& options) {
  pipeline::check_consistency(config);
  pipeline::check_fits(config, work);
  const Simulation simulation;
  if (options.exec) return std::make_unique<PinUnit<pipeline::ExecSource>>(config, work, options)->run();
  return std::make_unique<PinUnit<pipeline::ReplaySource>>(config, work, options)->run();
}

}  // namespace ctu::unit
