// A window of cycles as it went: where each ray was, what each stage did, how full each link was. It is looked at from
// outside after every cycle, so that a run without a timeline pays nothing for it and one with it takes the same
// cycles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/pipeline/context.h"
#include "model/pipeline/event_log.h"
#include "model/pipeline/probe.h"

namespace ctu::pipeline {

/// One stay of a ray, of those that the ray-latency accounts add up (context.h), cut to the window: cycles [begin,
/// end).
struct RayStay {
  std::uint64_t ray = 0;
  Slot slot = 0;
  Place place = Place::RaySetup;
  bool enters = false;  ///< the ray came into the unit with it, in the window
  bool leaves = false;  ///< and left the unit at its end, in the window
  Cycle begin = 0, end = 0;
};

/// What a stage was in cycles [begin, end).
struct StageSpan {
  int stage = 0;
  Activity activity = Activity::Idle;
  Cycle begin = 0, end = 0;
};

/// Entries of a link at the start of the cycles from `since` on.
struct LinkLevel {
  int link = 0;
  int entries = 0;
  Cycle since = 0;
};

class Timeline {
 public:
  /// Watches cycles [first, last].
  Timeline(Cycle first, Cycle last) : first_(first), last_(last) {}

  Cycle first() const { return first_; }
  Cycle last() const { return last_; }
  bool wants(Cycle now) const { return now >= first_ && now <= last_; }
  /// The links as they are at the start of cycle `now`.
  void sample_links(const Probes& probes, Cycle now);
  /// What the stages were in `now`, and where the rays are behind it.
  void sample(const Probes& probes, const Contexts& contexts, Cycle now);
  /// The run is over: `end` is its number of cycles.
  void close(Cycle end, const EventLog& log);

  /// In the order in which they ended; those that the window cuts are the last.
  const std::vector<RayStay>& stays() const { return stays_; }
  const std::vector<StageSpan>& stage_spans() const { return stage_spans_; }
  const std::vector<LinkLevel>& link_levels() const { return link_levels_; }
  /// Visits and returns of the window.
  const std::vector<Event>& events() const { return events_; }
  const std::vector<std::string>& stages() const { return stages_; }
  const std::vector<std::string>& links() const { return links_; }
  int contexts() const { return static_cast<int>(open_stays_.size()); }
  /// Cycles of the whole run, known when it is over.
  Cycle run_cycles() const { return run_cycles_; }
  /// One behind the last cycle that was watched.
  Cycle end() const { return run_cycles_ < last_ + 1 ? run_cycles_ : last_ + 1; }

 private:
  struct OpenStay {
    bool active = false;
    Cycle since = 0;  ///< not cut to the window
    RayStay stay;
  };
  void watch(OpenStay& open, const Context& context, const Stay& now_at, Slot slot, Cycle now);
  void end_stay(OpenStay& open, Cycle end, bool leaves);

  Cycle first_, last_, run_cycles_ = 0;
  std::vector<OpenStay> open_stays_;   ///< by context
  std::vector<StageSpan> open_spans_;  ///< by stage
  std::vector<int> entries_;           ///< by link; -1: not looked at yet
  std::vector<std::string> stages_, links_;
  std::vector<RayStay> stays_;
  std::vector<StageSpan> stage_spans_;
  std::vector<LinkLevel> link_levels_;
  std::vector<Event> events_;
};

}  // namespace ctu::pipeline
