// The RTL unit at work: rays go in, memory answers, hits come back and are checked.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "model/pipeline/backpressure.h"
#include "model/pipeline/memory_map.h"
#include "model/pipeline/result.h"
#include "model/pipeline/work.h"
#include "sim/cosim/rtl_unit.h"
#include "sim/cosim/unit_memory.h"

namespace ctu::cosim {

class RtlRun {
 public:
  /// Loads straps and tables. Throws Error where the build cannot run this configuration or work (rtl_builds.h).
  /// `stalls`: by the number of each link, what refuses; a number of -1 is no link of this configuration.
  RtlRun(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& work,
         const pipeline::Backpressure& stalls, const std::array<int, kLinks>& stall_numbers);

  /// One cycle, but for its end: every probe of the unit can be read.
  void begin();
  /// The end of the cycle. Throws Error when a ray needs a row of a table that mask_test.rows leaves out.
  void end();
  bool done() const { return next_ray() == nullptr && returned_ == taken_; }
  pipeline::Cycle cycles() const { return now_; }

  RtlUnit& unit() { return unit_; }
  /// Number in the trace of the ray that a context holds.
  std::uint64_t ray_in(pipeline::Slot slot) const { return in_slot_[slot].number; }
  std::uint64_t rays() const { return returned_; }
  std::uint64_t wrong_hits() const { return wrong_hits_; }
  const std::vector<pipeline::WrongHit>& first_wrong() const { return first_wrong_; }

 private:
  struct RayInSlot {
    std::uint64_t number = 0;
    intersect::Hit expected;
  };

  const intersect::Ray* next_ray() const { return block_ == nullptr ? nullptr : &block_->rays[index_]; }
  /// The next ray is the last one of its packet.
  bool ray_closes() const;
  void next_block();
  void take_ray(pipeline::Slot slot);
  void give_back(const ReturnedRay& returned);
  [[noreturn]] void throw_row_left_out(pipeline::Slot slot) const;
  std::uint64_t stalled(pipeline::Side side) const;

  RtlUnit& unit_;
  reference::RayFeed& feed_;
  UnitMemory memory_;
  pipeline::Backpressure stalls_;
  std::array<int, kLinks> stall_numbers_;
  std::shared_ptr<const reference::RayBlock> block_;
  std::uint32_t index_ = 0, packet_ = 0;
  std::vector<RayInSlot> in_slot_;
  pipeline::Cycle now_ = 0;
  std::uint64_t taken_ = 0, returned_ = 0, wrong_hits_ = 0;
  std::vector<pipeline::WrongHit> first_wrong_;
};

}  // namespace ctu::cosim
