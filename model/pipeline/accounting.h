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
  NoPacket,        ///< rays wait, the registers of all packets are taken
};
inline constexpr int kActivities = 12;

std::string_view name_of(Activity activity);
std::string_view description_of(Activity activity);

/// The account of one stage.
class Account {
 public:
  Account(std::string_view stage, std::initializer_list<Activity> causes) : stage_(stage), causes_(causes) {}

  /// What the stage was in this cycle; once in every cycle that is stepped.
  void set(Activity activity) {
    ++cycles_[static_cast<int>(activity)];
    current_ = activity;
  }
  /// The same once more for this cycle: it was something else.
  void correct(Activity activity) {
    --cycles_[static_cast<int>(current_)];
    set(activity);
  }
  /// Some of the cycles so far, where a stage is not stepped and its times are known otherwise (rigid_chain.h).
  void add(Activity activity, Cycle cycles) { cycles_[static_cast<int>(activity)] += cycles; }
  /// Of `end` cycles, those that are not charged to anything else were idle.
  void rest_idle(Cycle end);
  /// What reports show as current.
  void show(Activity activity) { current_ = activity; }
  /// `cycles` more in which nothing moves anywhere.
  void stand(Cycle cycles) { cycles_[static_cast<int>(current_)] += cycles; }
  Activity current() const { return current_; }
  std::string_view stage() const { return stage_; }
  StageAccount close() const;

 private:
  std::string_view stage_;
  std::vector<Activity> causes_;
  Activity current_ = Activity::Idle;
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
  PrimitiveCull,
  TriangleTest,
  SphereTest,
  HitUpdate,
  Result,
  PacketCull,
};
inline constexpr int kPlaces = 20;

std::string_view name_of(Place place);
std::string_view description_of(Place place);

}  // namespace ctu::pipeline
