#include "model/pipeline/engine.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "model/base/error.h"
#include "model/pipeline/connections.h"
#include "model/pipeline/deadlock_report.h"
#include "model/pipeline/exec_source.h"
#include "model/pipeline/parameter.h"
#include "model/pipeline/replay_source.h"
#include "model/pipeline/report.h"
#include "model/pipeline/wave_writer.h"

namespace ctu::pipeline {
namespace {

/// Joins ports and lists the links.
class PlainLinks {
 public:
  explicit PlainLinks(const Backpressure& backpressure) : backpressure_(backpressure) {}

  template <class T>
  void join(const char* name, PlainWiring::Out<T>& out, PlainWiring::In<T>& in) {
    out.link = &in.link;
    list(name, out, in);
  }
  template <class T>
  void join(const char* name, StallingWiring::Out<T>& out, StallingWiring::In<T>& in) {
    out.link = &in.link;
    out.number = in.number = static_cast<int>(probes_.links.size());
    out.backpressure = in.backpressure = &backpressure_;
    list(name, out, in);
  }
  Probes& probes() { return probes_; }

 private:
  template <class Out, class In>
  void list(const char* name, Out& out, In& in) {
    probes_.links.push_back({name, [&in](Cycle now) { return in.can_pop(now); },
                             [&out](Cycle now) { return out.can_push(now); }, [&in] { return in.link.occupancy(); }});
  }

  Backpressure backpressure_;
  Probes probes_;
};

template <class Source, class Wiring, bool kForward>
class PlainEngine final : public Engine {
 public:
  PlainEngine(const UnitConfig& config, const Work& work, const EngineOptions& options)
      : state_(config, work, options.keep_events),
        stages_(state_, work.rays),
        links_(options.backpressure),
        skip_idle_(options.skip_idle && !options.backpressure.any()),
        watchdog_(static_cast<Cycle>(config.watchdog.cycles)),
        progress_(options.progress) {
    for_each_link(stages_, state_.has_spills,
                  [&](const char* name, auto& out, auto& in) { links_.join(name, out, in); });
    for_each_stage(stages_, [&](auto& stage) { links_.probes().stages.push_back(&stage.account); });
    if (!options.waves_path.empty())
      waves_ =
          std::make_unique<WaveWriter>(options.waves_path, links_.probes(), options.waves_first, options.waves_last);
  }

  bool advance(Cycle until) override {
    while (!all_returned(stages_)) {
      if (now_ >= until) return false;
      const bool watched = waves_ != nullptr && waves_->wants(now_);
      if (watched) waves_->sample_links(now_);
      const bool moved = step(now_);
      if (watched) waves_->sample_stages(now_);
      if (moved) {
        last_moved_ = now_++;
      } else {
        wait(until);
      }
      if (progress_ && stages_.result_queue.rays() >= progress_due_) {
        progress_(stages_.result_queue.rays());
        progress_due_ = stages_.result_queue.rays() + kProgressRays;
      }
    }
    if (waves_ != nullptr) {
      waves_->close();
      waves_.reset();
    }
    return true;
  }

  Cycle now() const override { return now_; }
  int occupied_contexts() const override { return state_.contexts.occupied(); }
  const EventLog& log() const override { return state_.log; }
  UnitResult result() override { return make_result(state_, stages_, now_); }

 private:
  static constexpr std::uint64_t kProgressRays = 4096;

  /// One cycle of every stage. Any order gives the same, as links judge by the state at the start of the cycle.
  bool step(Cycle now) {
    bool moved = false;
    auto all = stages_.all();
    constexpr std::size_t kCount = std::tuple_size_v<decltype(all)>;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (if_present(std::get<(kForward ? I : kCount - 1 - I)>(all), [&](auto& stage) { moved |= stage.step(now); }), ...);
    }
    (std::make_index_sequence<kCount>{});
    return moved;
  }

  /// Nothing moved: goes to the next cycle in which something can.
  void wait(Cycle until) {
    if (now_ - last_moved_ >= watchdog_)
      throw DeadlockFound(deadlock_report(now_, last_moved_, links_.probes(), state_.contexts));
    Cycle next = now_ + 1;
    if (skip_idle_) {
      next = kNever;
      for_each_stage(stages_, [&](auto& stage) { next = earlier(next, stage.next_event(now_)); });
      next = std::max(next, now_ + 1);
      if (waves_ != nullptr && waves_->first() > now_) next = std::min(next, waves_->first());
    }
    next = std::min({next, until, last_moved_ + watchdog_});
    if (next > now_ + 1) for_each_stage(stages_, [&](auto& stage) { stage.account.stand(next - now_ - 1); });
    now_ = next;
  }

  UnitState<Source> state_;
  Stages<Source, Wiring> stages_;
  PlainLinks links_;
  bool skip_idle_;
  Cycle watchdog_, now_ = 0, last_moved_ = 0;
  std::unique_ptr<WaveWriter> waves_;
  std::function<void(std::uint64_t)> progress_;
  std::uint64_t progress_due_ = kProgressRays;
};

template <class Source>
std::unique_ptr<Engine> make_with(const UnitConfig& config, const Work& work, const EngineOptions& options) {
  if (options.reverse_order) return std::make_unique<PlainEngine<Source, StallingWiring, false>>(config, work, options);
  if (options.backpressure.any())
    return std::make_unique<PlainEngine<Source, StallingWiring, true>>(config, work, options);
  return std::make_unique<PlainEngine<Source, PlainWiring, true>>(config, work, options);
}

}  // namespace

std::unique_ptr<Engine> make_engine(const UnitConfig& config, const Work& work, const EngineOptions& options) {
  check_consistency(config);
  check_fits(config, work);
  return options.exec ? make_with<ExecSource>(config, work, options) : make_with<ReplaySource>(config, work, options);
}

UnitResult run_to_end(Engine& engine) {
  engine.advance(kNever);
  return engine.result();
}

}  // namespace ctu::pipeline
