#include "model/pipeline/engine.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "model/base/error.h"
#include "model/pipeline/connections.h"
#include "model/pipeline/deadlock_report.h"
#include "model/pipeline/exec_source.h"
#include "model/pipeline/node_chain.h"
#include "model/pipeline/parameter.h"
#include "model/pipeline/replay_source.h"
#include "model/pipeline/report.h"
#include "model/pipeline/wave_writer.h"

namespace ctu::pipeline {
namespace {

/// Joins ports and lists the links.
class PlainLinks {
 public:
  /// `row`: of the links within it and behind it, if there is one.
  PlainLinks(const Backpressure& backpressure, const RigidChain* row) : backpressure_(backpressure), row_(row) {}

  void join(const char* name, PlainWiring::Out<NodeToken>&, ChainExit&) {
    const auto entries = [row = row_, stage = row_links_++] { return row->occupancy(stage); };
    probes_.links.push_back(
        {name, [entries](Cycle) { return entries() > 0; }, [entries](Cycle) { return entries() < 2; }, entries});
  }

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
  const RigidChain* row_;
  int row_links_ = 0;
  Probes probes_;
};

/// What is stepped in a cycle: every stage,
template <class Source, class Wiring>
class Parts {
 public:
  Parts(UnitState<Source>&, Stages<Source, Wiring>& stages) : stages_(stages) {}
  auto all() { return stages_.all(); }
  RigidChain* row() { return nullptr; }

 private:
  Stages<Source, Wiring>& stages_;
};

/// or those of a node's way as one.
template <class Source>
class Parts<Source, ChainedWiring> {
 public:
  Parts(UnitState<Source>& state, Stages<Source, ChainedWiring>& stages) : stages_(stages), chain_(state, stages) {}
  auto all() {
    auto& s = stages_;
    return std::tie(s.ray_queue, s.packet_cull, s.scheduler, s.node_fetch, chain_, s.traversal_stack, s.leaf_fetch,
                    s.primitive_cull, s.triangle_test, s.sphere_test, s.hit_update, s.result_queue, s.memory_port);
  }
  RigidChain* row() { return &chain_.row(); }

 private:
  Stages<Source, ChainedWiring>& stages_;
  NodeChain<Source> chain_;
};

template <class Part>
void stand(Part& stage, Cycle cycles) {
  stage.account.stand(cycles);
}
/// Its accounts follow from when tokens came and went.
template <class Source>
void stand(NodeChain<Source>&, Cycle) {}

template <class Source, class Wiring, bool kForward>
class PlainEngine final : public Engine {
 public:
  PlainEngine(const UnitConfig& config, const Work& work, const EngineOptions& options)
      : state_(config, work, options.keep_events),
        stages_(state_, work.rays),
        parts_(state_, stages_),
        links_(options.backpressure, parts_.row()),
        skip_idle_(options.skip_idle && !options.backpressure.any()),
        watchdog_(static_cast<Cycle>(config.watchdog.cycles)),
        keep_events_(options.keep_events),
        timeline_(options.timeline),
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
      const bool waved = waves_ != nullptr && waves_->wants(now_);
      const bool watched = timeline_ != nullptr && timeline_->wants(now_);
      if (waved) waves_->sample_links(now_);
      if (watched) begin_watched();
      const bool moved = step(now_);
      if (waved) waves_->sample_stages(now_);
      if (watched) end_watched();
      if (moved) {
        last_moved_ = now_++;
      } else {
        wait(until);
      }
      if (stages_.result_queue.rays() >= progress_due_) {
        if (progress_) progress_(stages_.result_queue.rays());
        progress_due_ = stages_.result_queue.rays() + kProgressRays;
      }
    }
    if (waves_ != nullptr) {
      waves_->close();
      waves_.reset();
    }
    if (timeline_ != nullptr) std::exchange(timeline_, nullptr)->close(now_, state_.log);
    return true;
  }

  Cycle now() const override { return now_; }
  int occupied_contexts() const override { return state_.contexts.occupied(); }
  const EventLog& log() const override { return state_.log; }
  void warm(accel::ChildRef ref) override {
    if (accel::is_leaf(ref))
      stages_.leaf_fetch.warm({ref, 0});
    else
      stages_.node_fetch.warm({ref, 0});
  }
  UnitResult result() override {
    if (parts_.row() != nullptr) parts_.row()->close_accounts(now_);
    return make_result(state_, stages_, now_);
  }

 private:
  static constexpr std::uint64_t kProgressRays = 4096;

  void begin_watched() {
    state_.log.keep_events(true);
    timeline_->sample_links(links_.probes(), now_);
  }
  void end_watched() {
    timeline_->sample(links_.probes(), state_.contexts, now_);
    state_.log.keep_events(keep_events_);
  }

  /// One cycle of every stage. Any order gives the same, as links judge by the state at the start of the cycle.
  bool step(Cycle now) {
    bool moved = false;
    auto all = parts_.all();
    constexpr std::size_t kCount = std::tuple_size_v<decltype(all)>;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (if_present(std::get<(kForward ? I : kCount - 1 - I)>(all), [&](auto& part) { moved |= part.step(now); }), ...);
    }
    (std::make_index_sequence<kCount>{});
    return moved;
  }

  /// Nothing moved: goes to the next cycle in which something can.
  void wait(Cycle until) {
    if (parts_.row() != nullptr && parts_.row()->next_event(now_) != kNever) last_moved_ = now_;
    if (now_ - last_moved_ >= watchdog_) {
      if (parts_.row() != nullptr) parts_.row()->show(now_);
      throw DeadlockFound(deadlock_report(now_, last_moved_, links_.probes(), state_.contexts));
    }
    Cycle next = now_ + 1;
    if (skip_idle_) {
      next = kNever;
      for_each_part([&](auto& part) { next = earlier(next, part.next_event(now_)); });
      next = std::max(next, now_ + 1);
      if (waves_ != nullptr && waves_->first() > now_) next = std::min(next, waves_->first());
      if (timeline_ != nullptr && timeline_->first() > now_) next = std::min(next, timeline_->first());
    }
    next = std::min({next, until, last_moved_ + watchdog_});
    if (next > now_ + 1) for_each_part([&](auto& part) { stand(part, next - now_ - 1); });
    now_ = next;
  }

  template <class Visit>
  void for_each_part(Visit&& visit) {
    std::apply([&](auto&... part) { (if_present(part, visit), ...); }, parts_.all());
  }

  UnitState<Source> state_;
  Stages<Source, Wiring> stages_;
  Parts<Source, Wiring> parts_;
  PlainLinks links_;
  bool skip_idle_;
  Cycle watchdog_, now_ = 0, last_moved_ = 0;
  bool keep_events_;
  Timeline* timeline_;
  std::unique_ptr<WaveWriter> waves_;
  std::function<void(std::uint64_t)> progress_;
  std::uint64_t progress_due_ = kProgressRays;
};

template <class Source>
std::unique_ptr<Engine> make_with(const UnitConfig& config, const Work& work, const EngineOptions& options) {
  if (options.reverse_order) return std::make_unique<PlainEngine<Source, StallingWiring, false>>(config, work, options);
  if (options.backpressure.any())
    return std::make_unique<PlainEngine<Source, StallingWiring, true>>(config, work, options);
  const bool watched = !options.waves_path.empty() || options.timeline != nullptr;  // what stages are in every cycle
  if (config.table_cache.bytes > 0 || watched)
    return std::make_unique<PlainEngine<Source, PlainWiring, true>>(config, work, options);
  return std::make_unique<PlainEngine<Source, ChainedWiring, true>>(config, work, options);
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
