// The unit in plain C++ with every handshake open to be watched, one cycle at a time: the model's side of a
// co-simulation.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/pipeline/connections.h"
#include "model/pipeline/exec_source.h"
#include "model/pipeline/parameter.h"
#include "model/pipeline/pipeline.h"
#include "model/pipeline/report.h"
#include "model/pipeline/tapped_wiring.h"

namespace ctu::pipeline {

class TappedUnit {
 public:
  using AllStages = Stages<ExecSource, TappedWiring>;

  /// Throws Error on a configuration or work that cannot be.
  TappedUnit(const UnitConfig& config, const Work& work, const Backpressure& backpressure = {})
      : backpressure_(backpressure), state_(checked(config, work), work, false), stages_(state_, work.rays) {
    for_each_link(stages_, state_.has_spills, [&](const char* name, auto& out, auto& in) { join(name, out, in); });
  }
  TappedUnit(const TappedUnit&) = delete;
  TappedUnit& operator=(const TappedUnit&) = delete;

  /// One cycle. Afterwards each port tells what it saw and did, each account what its stage was.
  void step() {
    for (const auto& sample : samples_) sample(now_);
    for_each_stage(stages_, [&](auto& stage) { stage.step(now_); });
    ++now_;
  }
  /// Every ray has been returned.
  bool done() { return all_returned(stages_); }
  /// Cycles done; during what follows a step(), the number of the cycle behind it.
  Cycle cycles() const { return now_; }

  AllStages& stages() { return stages_; }
  UnitState<ExecSource>& state() { return state_; }
  const Backpressure& backpressure() const { return backpressure_; }
  /// In the order of for_each_link, whose numbers Backpressure knows them by.
  const std::vector<std::string>& link_names() const { return names_; }
  UnitResult result() { return make_result(state_, stages_, now_); }

 private:
  static const UnitConfig& checked(const UnitConfig& config, const Work& work) {
    check_consistency(config);
    check_fits(config, work);
    return config;
  }

  template <class Out, class In>
  void join(const char* name, Out& out, In& in) {
    out.link = &in.link;
    out.number = in.number = static_cast<int>(names_.size());
    out.backpressure = in.backpressure = &backpressure_;
    names_.emplace_back(name);
    samples_.emplace_back([&out, &in](Cycle now) {
      out.sample(now);
      in.sample(now);
    });
  }

  Backpressure backpressure_;
  UnitState<ExecSource> state_;
  AllStages stages_;
  std::vector<std::string> names_;
  std::vector<std::function<void(Cycle)>> samples_;
  Cycle now_ = 0;
};

}  // namespace ctu::pipeline
