// Contract 4: in every cycle a stage is busy, idle, or stalled by one named cause; and every cycle of a ray's stay in
// the unit is charged to one place.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "model/pipeline/cycle.h"
#include "model/pipeline/result.h"

namespace ctu::pipeline {

/// What a stage was in a cycle. Everything behind Idle is a cause of a stall.
enum class Activity : std::uint8_t {
  Busy,
  Idle,
  OutputFull,      ///< the link behind is full
  NoContext,       ///< rays wait, no context is free
  BankConflict,    ///< a second turn at a table's bank
  MshrsFull,       ///< a line misses and no miss register is free
  MemoryPortFull,  ///< the request link to memory is full
  FillPort,        ///< the tag array takes a line that arrives
  Memory,          ///< nothing to do but wait for memory
  Spill,           ///< the short stack is full: entries go to memory first
  Interval,        ///< the initiation interval is not over
};
inline constexpr int kActivities = 11;

std::string_view name_of(Activity activity);
std::string_view description_of(Activity activity);

/// The account of one stage. A cycle that is not set again keeps what the cycle before had, so skipping cycles in which
/// nothing moves needs no work here.
class Account {
 public:
  Account(std::string_view stage, std::initializer_list<Activity> causes) : stage_(stage), causes_(causes) {}

  /// The stage's activity in cycle `now`; at most once a cycle, in ascending order.
  void set(Cycle now, Activity activity) {
    cycles_[static_cast<int>(current_)] += now - since_;
    since_ = now;
    current_ = activity;
  }
  Activity current() const { return current_; }
  std::string_view stage() const { return stage_; }
  StageAccount close(Cycle end) const;

 private:
  std::string_view stage_;
  std::vector<Activity> causes_;
  Activity current_ = Activity::Idle;
  Cycle since_ = 0;
  std::array<std::uint64_t, kActivities> cycles_{};
};

/// Where a ray is: from the cycle in which the stage takes it to the cycle in which the next one does, so waiting in
/// the link behind a stage counts for that stage.
enum class Place : std::uint8_t {
  RaySetup,
  Scheduler,
  NodeFetchHit,
  NodeFetchMiss,
  BoxTest,
  CellLocate,
  TableFetchHit,
  TableFetchMiss,
  MaskTest,
  ChildSort,
  Stack,
  StackRefill,
  LeafFetchHit,
  LeafFetchMiss,
  TriangleTest,
  HitUpdate,
  Result,
};
inline constexpr int kPlaces = 17;

std::string_view name_of(Place place);
std::string_view description_of(Place place);

}  // namespace ctu::pipeline
