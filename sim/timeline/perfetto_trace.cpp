#include "sim/timeline/perfetto_trace.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sim/timeline/proto_message.h"
#include "sim/timeline/ray_visit.h"

namespace ctu::sim {
namespace {

using pipeline::Cycle;

// Field numbers of perfetto/protos: trace.proto, trace_packet.proto, track_event.proto, track_descriptor.proto,
// process_descriptor.proto, interned_data.proto.
namespace field {
constexpr int kTracePacket = 1;
constexpr int kTimestamp = 8, kSequence = 10, kTrackEvent = 11, kInternedData = 12, kSequenceFlags = 13,
              kTrackDescriptor = 60;
constexpr int kEventType = 9, kEventNameId = 10, kEventTrack = 11, kCounterValue = 30;
constexpr int kTrackId = 1, kTrackName = 2, kTrackProcess = 3, kTrackParent = 5, kTrackCounter = 8;
constexpr int kProcessId = 1, kProcessName = 6;
constexpr int kInternedNames = 2, kInternedId = 1, kInternedText = 2;
}  // namespace field
enum EventType : std::uint64_t { kSliceBegin = 1, kSliceEnd = 2, kCounter = 4 };
enum SequenceFlags : std::uint64_t { kStateCleared = 1, kNeedsState = 2 };

class Trace {
 public:
  Trace() { append(packet().number(field::kSequenceFlags, kStateCleared | kNeedsState)); }

  std::uint64_t add_group(const std::string& name) {
    ProtoMessage process;
    process.number(field::kProcessId, next_track_).text(field::kProcessName, name);
    return add_track(ProtoMessage().message(field::kTrackProcess, process));
  }
  std::uint64_t add_track(std::uint64_t group, const std::string& name) {
    return add_track(ProtoMessage().number(field::kTrackParent, group).text(field::kTrackName, name));
  }
  std::uint64_t add_counter(std::uint64_t group, const std::string& name) {
    return add_track(ProtoMessage()
                         .number(field::kTrackParent, group)
                         .text(field::kTrackName, name)
                         .message(field::kTrackCounter, {}));
  }

  /// Slices of a track that begin or end in the same cycle are given from the outer to the inner one, and back.
  void begin(std::uint64_t track, Cycle at, const std::string& name) {
    add_event(at, event(kSliceBegin, track).number(field::kEventNameId, id_of(name)));
  }
  void end(std::uint64_t track, Cycle at) { add_event(at, event(kSliceEnd, track)); }
  void count(std::uint64_t track, Cycle at, int value) {
    add_event(at, event(kCounter, track).number(field::kCounterValue, static_cast<std::uint64_t>(value)));
  }

  /// Everything, in the order of time.
  std::string bytes() {
    std::stable_sort(events_.begin(), events_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [at, event] : events_)
      append(packet()
                 .number(field::kTimestamp, at)
                 .number(field::kSequenceFlags, kNeedsState)
                 .message(field::kTrackEvent, event));
    return std::move(bytes_);
  }

 private:
  static ProtoMessage packet() { return ProtoMessage().number(field::kSequence, 1); }
  static ProtoMessage event(EventType type, std::uint64_t track) {
    return ProtoMessage().number(field::kEventType, type).number(field::kEventTrack, track);
  }
  void append(const ProtoMessage& packet) { bytes_ += ProtoMessage().message(field::kTracePacket, packet).bytes(); }
  void add_event(Cycle at, ProtoMessage event) { events_.emplace_back(at, std::move(event)); }

  std::uint64_t add_track(ProtoMessage descriptor) {
    descriptor.number(field::kTrackId, next_track_);
    append(packet().message(field::kTrackDescriptor, descriptor));
    return next_track_++;
  }

  /// Names are written once; they stand before all events.
  std::uint64_t id_of(const std::string& name) {
    const auto [entry, is_new] = ids_.try_emplace(name, ids_.size() + 1);
    if (is_new) {
      const ProtoMessage text =
          ProtoMessage().number(field::kInternedId, entry->second).text(field::kInternedText, name);
      append(packet()
                 .number(field::kSequenceFlags, kNeedsState)
                 .message(field::kInternedData, ProtoMessage().message(field::kInternedNames, text)));
    }
    return entry->second;
  }

  std::uint64_t next_track_ = 1;
  std::map<std::string, std::uint64_t> ids_;
  std::vector<std::pair<Cycle, ProtoMessage>> events_;
  std::string bytes_;
};

void add_rays(Trace& trace, const pipeline::Timeline& timeline) {
  const std::uint64_t group = trace.add_group("rays, by context");
  std::vector<std::uint64_t> tracks;
  for (int slot = 0; slot < timeline.contexts(); ++slot)
    tracks.push_back(trace.add_track(group, fmt::format("context {:03}", slot)));
  const std::vector<RayVisit> visits = ray_visits(timeline);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const RayVisit& visit = visits[i];
    const std::uint64_t track = tracks[visit.slot];
    if (!visit.follows) trace.begin(track, visit.begin(), fmt::format("ray {}", visit.ray));
    trace.begin(track, visit.begin(), describe(visit));
    for (const pipeline::RayStay& stay : visit.stays) {
      trace.begin(track, stay.begin, std::string(pipeline::name_of(stay.place)));
      trace.end(track, stay.end);
    }
    trace.end(track, visit.end());
    const bool last = i + 1 == visits.size() || !visits[i + 1].follows;
    if (last) trace.end(track, visit.end());
  }
}

void add_stages(Trace& trace, const pipeline::Timeline& timeline) {
  const std::uint64_t group = trace.add_group("stages");
  std::vector<std::uint64_t> tracks;
  for (const std::string& stage : timeline.stages()) tracks.push_back(trace.add_track(group, stage));
  for (const pipeline::StageSpan& span : timeline.stage_spans()) {
    if (span.activity == pipeline::Activity::Idle) continue;
    const std::uint64_t track = tracks[static_cast<std::size_t>(span.stage)];
    trace.begin(track, span.begin, std::string(pipeline::name_of(span.activity)));
    trace.end(track, span.end);
  }
}

void add_links(Trace& trace, const pipeline::Timeline& timeline) {
  const std::uint64_t group = trace.add_group("links, entries");
  std::vector<std::uint64_t> tracks;
  for (const std::string& link : timeline.links()) tracks.push_back(trace.add_counter(group, link));
  for (const pipeline::LinkLevel& level : timeline.link_levels())
    trace.count(tracks[static_cast<std::size_t>(level.link)], level.since, level.entries);
}

}  // namespace

std::string perfetto_trace(const pipeline::Timeline& timeline) {
  Trace trace;
  add_rays(trace, timeline);
  add_stages(trace, timeline);
  add_links(trace, timeline);
  return trace.bytes();
}

}  // namespace ctu::sim
