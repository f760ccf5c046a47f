// What happened, comparable between executions: every visit and every return with its cycle.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/pipeline/cycle.h"
#include "model/reference/step.h"

namespace ctu::pipeline {

struct Event {
  Cycle cycle = 0;
  std::uint64_t ray = 0;
  std::uint32_t visit = 0;  ///< number of the visit within its ray; of a return, how many there were
  bool is_return = false;
  reference::Step step;  ///< of a return: `ref` holds the primitive found
  bool operator==(const Event&) const = default;
};

/// Two sums over all events, so that the order of stages within a cycle does not matter: one over (cycle, ray, step),
/// one over (ray, number of the visit, step), which no timing may change (contract 3). `keep_events` also keeps the
/// events.
class EventLog {
 public:
  explicit EventLog(bool keep_events = false) : keep_events_(keep_events) {}

  void add(const Event& event) {
    const std::uint64_t what =
        (std::bit_cast<std::uint64_t>(event.step) ^ (event.is_return ? kReturn : 0)) * 0x9E3779B97F4A7C15ull +
        event.ray * 0xD1B54A32D192ED03ull;
    timed_hash_ += product(what, event.cycle * 2 + 0x8CB92BA72F3D8DD7ull);
    untimed_hash_ += product(what, event.visit * 2 + 0xAEF17502108EF2D9ull);
    if (keep_events_) events_.push_back(event);
  }

  /// Whether events from now on are kept.
  void keep_events(bool keep) { keep_events_ = keep; }

  std::uint64_t timed_hash() const { return timed_hash_; }
  std::uint64_t untimed_hash() const { return untimed_hash_; }
  const std::vector<Event>& events() const { return events_; }

 private:
  /// The two halves of the 128-bit product, folded: cheap, and every bit of both factors counts.
  static std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    const unsigned __int128 both = static_cast<unsigned __int128>(a) * b;
    return static_cast<std::uint64_t>(both) ^ static_cast<std::uint64_t>(both >> 64);
  }

  static constexpr std::uint64_t kReturn = 0x5851F42D4C957F2Dull;
  bool keep_events_;
  std::uint64_t timed_hash_ = 0, untimed_hash_ = 0;
  std::vector<Event> events_;
};

}  // namespace ctu::pipeline
