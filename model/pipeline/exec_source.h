// Outcomes computed from rays and image, with the arithmetic of model/intersect and model/cull. Where steps are
// recorded too, every event is compared with the recorded one.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/mask_test.h"
#include "model/cull/packet/packet_slabs.h"
#include "model/pipeline/outcome.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"
#include "model/reference/entry_list.h"

namespace ctu::pipeline {

inline constexpr int kMaxStackEntries = 256;  ///< of one ray, on chip and spilled

class ExecSource {
 public:
  using Test = ComputedTest;
  static constexpr bool kComputes = true;
  /// Words of a ray mask of the largest resolution.
  static constexpr int kMaxWords = cull::words_per_mask(cull::kMaxResolution);

  /// Computed values of a context.
  struct Registers {
    intersect::PreparedRay ray;
    intersect::SlabTimes times;
    intersect::Hit best;
    reference::Step step;  ///< the visit's event so far
    const reference::Step *recorded = nullptr, *recorded_end = nullptr;
    const std::uint16_t *recorded_met = nullptr, *recorded_met_end = nullptr;
    std::uint8_t recorded_tail = 0;
    std::uint8_t dropped = 0;  ///< since the last visit
    std::uint32_t key[intersect::kLanes] = {};
    std::uint64_t touched[intersect::kLanes][kMaxWords] = {};  ///< of comparators
    float stack_t0[kMaxStackEntries] = {}, stack_t1[kMaxStackEntries] = {};
    float t0 = 0, t1 = 0;  ///< of the ray's stay in the box that it goes to next, or is in
  };

  ExecSource(const UnitConfig& config, const UnitImage& image, const cull::MaskTester& tester, Contexts& contexts);

  bool begin(Slot slot);
  void open_packet(int packet, Slot leader);
  void join_packet(int packet, Slot slot);
  float packet_begins(int packet) const { return packets_[static_cast<std::size_t>(packet)].slabs.begins(); }
  cull::packet::PacketTimes packet_test(int packet, std::uint32_t node);
  reference::EntryList packet_entries(int packet, const reference::EntryList& found);
  void started(Slot slot, int position, const reference::Entry& entry) {
    registers_[slot].stack_t0[position] = entry.t0;
  }
  void visit(Slot slot, accel::ChildRef ref);
  std::uint8_t box_test(Slot slot, accel::ChildRef node);
  std::uint8_t locate(Slot slot, unsigned hits);
  LaneKeys keys(const NodeToken& token) const;
  MaskAnswer mask_test(const NodeToken& token);
  std::uint8_t child_order(Slot slot, unsigned survivors);
  void pushed(Slot slot, int position, int lane);
  void begin_pop(Slot) {}
  bool drops(Slot slot, int position);
  void goes_to_child(Slot slot, int lane);
  void goes_to_entry(Slot slot, int position);
  std::uint16_t primitive_cull(Slot slot, accel::ChildRef leaf);
  Test triangle_test(Slot slot, accel::ChildRef leaf, int index, bool last);
  Test sphere_test(const Test& test);
  void update(const Test& test);
  bool has_hit(Slot slot) const { return registers_[slot].best.primitive != intersect::kNoPrimitive; }
  reference::Step finish_visit(Slot slot);
  intersect::Hit finish(Slot slot, const accel::Image& bytes);
  /// Visits and entries, and drops at the end of a ray, that differ from the recorded ones.
  std::uint64_t event_mismatches() const { return event_mismatches_; }
  /// What the context holds now: what a twin's register files are compared with.
  const Registers& registers(Slot slot) const { return registers_[slot]; }

 private:
  bool passes(const Registers& r, int lane) const;
  /// The cells the ray touches, by the design's tables or comparators; `projected` is room for a mask.
  const std::uint64_t* ray_mask(const Registers& r, int lane, std::uint64_t* projected) const;
  /// The answers for every entry of the compression LUT.
  const std::uint64_t* bit_row(const Registers& r, int lane) const;

  /// Of a packet: its bounds, and what is recorded of it.
  struct PacketRegisters {
    cull::packet::PacketSlabs slabs;
    std::shared_ptr<const reference::RayBlock> block;  ///< null where nothing is recorded
    std::uint64_t number = 0, visits = 0;
  };

  const UnitImage& image_;
  Contexts& contexts_;
  const cull::MaskTester& tester_;
  cull::Design design_;
  int resolution_, ray_resolution_, words_;
  bool reads_bit_rows_;
  std::vector<Registers> registers_;
  std::vector<PacketRegisters> packets_;  ///< none where rays travel alone
  std::uint64_t event_mismatches_ = 0;
};

}  // namespace ctu::pipeline
