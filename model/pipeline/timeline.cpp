#include "model/pipeline/timeline.h"

#include <algorithm>

namespace ctu::pipeline {

void Timeline::sample_links(const Probes& probes, Cycle now) {
  if (links_.empty()) {
    for (const LinkProbe& link : probes.links) links_.push_back(link.name);
    entries_.assign(links_.size(), -1);
  }
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const int entries = probes.links[i].occupancy();
    if (entries == entries_[i]) continue;
    entries_[i] = entries;
    link_levels_.push_back({static_cast<int>(i), entries, now});
  }
}

void Timeline::sample(const Probes& probes, const Contexts& contexts, Cycle now) {
  if (stages_.empty()) {
    open_stays_.resize(static_cast<std::size_t>(contexts.count()));
    for (const Account* stage : probes.stages) {
      open_spans_.push_back({static_cast<int>(stages_.size()), stage->current(), now, now});
      stages_.emplace_back(stage->stage());
    }
  }
  for (std::size_t i = 0; i < open_spans_.size(); ++i) {
    StageSpan& span = open_spans_[i];
    const Activity activity = probes.stages[i]->current();
    if (activity == span.activity) continue;
    span.end = now;
    stage_spans_.push_back(span);
    span.activity = activity;
    span.begin = now;
  }
  for (int slot = 0; slot < contexts.count(); ++slot)
    watch(open_stays_[static_cast<std::size_t>(slot)], contexts[slot], contexts.stay(slot), static_cast<Slot>(slot),
          now);
}

/// A context stays empty for at least a cycle, as its number goes back to ray_queue on a link, so no ray is missed; and
/// a ray comes to one place a cycle, as it goes from each to the next on a link.
void Timeline::watch(OpenStay& open, const Context& context, const Stay& at, Slot slot, Cycle now) {
  if (open.active) {
    if (!context.in_flight) {
      end_stay(open, now, true);
    } else if (at.since != open.since) {
      end_stay(open, at.since, false);
    } else {
      open.stay.place = at.place;  // a fetch that was a hit so far has missed a line
    }
  }
  if (open.active || !context.in_flight) return;
  open.active = true;
  open.since = at.since;
  open.stay = {context.ray,
               slot,
               at.place,
               at.since == context.entered && at.since >= first_,
               false,
               std::max(at.since, first_),
               0};
}

void Timeline::end_stay(OpenStay& open, Cycle end, bool leaves) {
  open.active = false;
  open.stay.end = end;
  open.stay.leaves = leaves;
  if (open.stay.end > open.stay.begin) stays_.push_back(open.stay);
}

void Timeline::close(Cycle run_cycles, const EventLog& log) {
  run_cycles_ = run_cycles;
  for (OpenStay& open : open_stays_)
    if (open.active) end_stay(open, end(), false);
  for (StageSpan& span : open_spans_) {
    span.end = end();
    if (span.end > span.begin) stage_spans_.push_back(span);
  }
  for (const Event& event : log.events())
    if (wants(event.cycle)) events_.push_back(event);
}

}  // namespace ctu::pipeline
