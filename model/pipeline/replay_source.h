// Outcomes from the recorded steps: no arithmetic, and every reference the unit pops is compared with the recorded one.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "model/cull/packet/packet_slabs.h"
#include "model/pipeline/outcome.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"
#include "model/reference/entry_list.h"
#include "model/reference/primitive_test.h"

namespace ctu::pipeline {

class ReplaySource {
 public:
  using Test = RecordedTest;
  static constexpr bool kComputes = false;

  ReplaySource(const UnitConfig& config, const UnitImage& image, const cull::MaskTester&, Contexts& contexts)
      : image_(image),
        contexts_(contexts),
        keyed_(cull::reads_tables(config.mask_test.design)),
        boxed_(image.primitive_boxes()),
        registers_(static_cast<std::size_t>(contexts.count())),
        packets_(image.packet_entries() > 0 ? static_cast<std::size_t>(config.packet_cull.packets) : 0) {}

  /// Sets up a context for its ray; whether the ray visits anything.
  bool begin(Slot slot) {
    const Context& context = contexts_[slot];
    const reference::StepList& list = context.block->steps;
    Registers& r = registers_[slot];
    r.step = list.steps.data() + list.first_step[context.index];
    r.end = list.steps.data() + list.first_step[context.index + 1];
    r.tail_dropped = list.tail_dropped[context.index];
    if (keyed_) {
      r.key = list.keys.data() + list.first_key[context.index];
      r.key_end = list.keys.data() + list.first_key[context.index + 1];
    }
    if (boxed_) r.met = list.met.data() + list.first_met[context.index];
    r.drops_left = 0;
    r.best = intersect::kNoPrimitive;
    __builtin_prefetch(r.step);  // a place of its own for every ray, first looked at when it is issued
    __builtin_prefetch(r.key);
    if (!packets_.empty()) return intersect::is_valid(context.block->rays[context.index]);  // it may be all packet
    return r.step != r.end;
  }

  /// A packet begins, with its first ray.
  void open_packet(int packet, Slot leader) {
    const Context& context = contexts_[leader];
    packets_[static_cast<std::size_t>(packet)] = {context.block, context.packet, 0, leader};
  }
  void join_packet(int, Slot) {}
  float packet_begins(int) const { return 0; }
  /// The children of `node` that some ray of the packet may meet, or every ray does; the times are not needed.
  cull::packet::PacketTimes packet_test(int packet, std::uint32_t node) {
    PacketRegisters& r = packets_[static_cast<std::size_t>(packet)];
    const reference::PacketList& list = r.block->packets;
    const std::uint64_t visit = list.first_visit[r.number] + r.visits++;
    if (visit >= list.first_visit[r.number + 1] || list.visits[visit].node != node)
      throw_event_mismatch(contexts_[r.leader],
                           "its packet visits " + std::to_string(node) + ", which is not recorded");
    cull::packet::PacketTimes times;
    times.hit = static_cast<std::uint8_t>(list.visits[visit].hit());
    times.sure = static_cast<std::uint8_t>(list.visits[visit].sure());
    return times;
  }
  /// Where the packet's rays go on, nearest first.
  reference::EntryList packet_entries(int packet, const reference::EntryList& found) {
    const PacketRegisters& r = packets_[static_cast<std::size_t>(packet)];
    const reference::PacketList& list = r.block->packets;
    const std::uint64_t first = list.first_entry[r.number], last = list.first_entry[r.number + 1];
    if (last - first != static_cast<std::uint64_t>(found.count()))
      throw_event_mismatch(contexts_[r.leader], "its packet ends with other entries than are recorded");
    reference::EntryList entries;
    for (std::uint64_t i = first; i < last; ++i) entries.add({list.entries[i], 0});
    return entries;
  }

  /// A visit begins.
  void visit(Slot slot, accel::ChildRef ref) {
    const Registers& r = registers_[slot];
    if (r.step == r.end || r.step->ref != ref || r.drops_left != 0) [[unlikely]]
      refuse_visit(slot, ref);
    image_.prefetch(ref);
  }

  std::uint8_t box_test(Slot slot, accel::ChildRef) {
    return static_cast<std::uint8_t>(registers_[slot].step->box_hits());
  }
  /// The lanes of the node that are asked: hit, and the object mask is not full.
  std::uint8_t locate(Slot slot, unsigned hits) {
    const Registers& r = registers_[slot];
    if (keyed_ && r.key_end - r.key < std::popcount(hits)) [[unlikely]]
      throw_event_mismatch(contexts_[slot], "a recorded table key is missing");
    return static_cast<std::uint8_t>(hits & ~image_.full_lanes(r.step->ref));
  }
  /// What the lanes asked read tables by. Keys are recorded for every lane hit.
  LaneKeys keys(const NodeToken& token) const {
    const Registers& r = registers_[token.slot];
    LaneKeys keys;
    const std::uint32_t* key = r.key;
    for (unsigned rest = token.hits; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      const std::uint32_t recorded = keyed_ ? *key++ : 0;
      if ((token.asked >> lane & 1) == 0) continue;
      keys.key[keys.count] = recorded;
      if (image_.compressed()) keys.mask_index[keys.count] = image_.mask_index(r.step->ref, lane);
      ++keys.count;
    }
    return keys;
  }
  MaskAnswer mask_test(const NodeToken& token) {
    Registers& r = registers_[token.slot];
    if (keyed_) r.key += std::popcount(token.hits);
    const reference::Step& step = *r.step;
    return {static_cast<std::uint8_t>(step.survivors()), static_cast<std::uint8_t>(step.uncertain())};
  }
  std::uint8_t child_order(Slot slot, unsigned) {
    return static_cast<std::uint8_t>(registers_[slot].step->detail & 0xFFu);
  }

  void pushed(Slot, int, int) {}
  void started(Slot, int, const reference::Entry&) {}
  /// A pop begins: `drops` of the recording are due first.
  void begin_pop(Slot slot) {
    Registers& r = registers_[slot];
    r.drops_left = r.step == r.end ? r.tail_dropped : r.step->dropped;
  }
  /// Whether the entry at `position` lies beyond the best hit.
  bool drops(Slot slot, int) {
    Registers& r = registers_[slot];
    if (r.drops_left == 0) return false;
    --r.drops_left;
    return true;
  }

  // Where a ray goes next, and what it knows of the way there, plays no part here.
  void goes_to_child(Slot, int) {}
  void goes_to_entry(Slot, int) {}

  /// Primitives of the leaf that are to be tested, bit by bit.
  std::uint16_t primitive_cull(Slot slot, accel::ChildRef) { return *registers_[slot].met++; }
  Test triangle_test(Slot slot, accel::ChildRef leaf, int index, bool last) {
    return {slot, static_cast<std::uint8_t>(index), last,
            image_.is_sphere(accel::leaf_first(leaf) + static_cast<unsigned>(index))};
  }
  Test sphere_test(const Test& test) { return test; }
  /// The outcome of a test reaches the best hit.
  void update(const Test& test) {
    Registers& r = registers_[test.slot];
    if ((r.step->became_best() >> test.index) & 1u) {
      r.best_triangle = accel::leaf_first(r.step->ref) + test.index;
      r.best = image_.primitive(r.best_triangle);
    }
  }
  bool has_hit(Slot slot) const { return registers_[slot].best != intersect::kNoPrimitive; }

  /// The visit is over: its event. `dropped` entries went before it.
  reference::Step finish_visit(Slot slot) { return *registers_[slot].step++; }

  /// The ray is over. Its hit: the recording says which triangle; t, u and v follow from ray and triangle, so they are
  /// the expected ones when the triangle is.
  intersect::Hit finish(Slot slot, const accel::Image& bytes) {
    const Registers& r = registers_[slot];
    const Context& context = contexts_[slot];
    if (r.step != r.end) throw_event_mismatch(context, "the unit ends before the recording does");
    if (r.drops_left != 0) throw_event_mismatch(context, "the recording drops entries that the stack does not hold");
    const intersect::Hit& expected = context.block->expected[context.index];
    if (r.best == expected.primitive) return expected;
    const intersect::Ray& ray = context.block->rays[context.index];
    intersect::Hit hit;
    hit.t = ray.tmax;
    if (r.best == intersect::kNoPrimitive) return hit;
    reference::test_primitive<true>(intersect::prepare_ray(ray), accel::read_triangle(bytes, r.best_triangle), hit);
    return hit;
  }
  std::uint64_t event_mismatches() const { return 0; }

 private:
  [[noreturn, gnu::cold, gnu::noinline]] void refuse_visit(Slot slot, accel::ChildRef ref) const {
    const Registers& r = registers_[slot];
    if (r.step == r.end) throw_event_mismatch(contexts_[slot], "the unit visits more than was recorded");
    throw_event_mismatch(contexts_[slot], "the unit visits " + std::to_string(ref) + " after " +
                                              std::to_string(r.drops_left) + " drops too few, recorded is " +
                                              std::to_string(r.step->ref));
  }

  struct Registers {
    const reference::Step *step = nullptr, *end = nullptr;
    const std::uint32_t *key = nullptr, *key_end = nullptr;
    const std::uint16_t* met = nullptr;  ///< of the next leaf
    std::uint32_t best = intersect::kNoPrimitive, best_triangle = 0;
    std::uint8_t tail_dropped = 0, drops_left = 0;
  };

  struct PacketRegisters {
    std::shared_ptr<const reference::RayBlock> block;
    std::uint64_t number = 0, visits = 0;
    Slot leader = 0;
  };

  const UnitImage& image_;
  Contexts& contexts_;
  bool keyed_, boxed_;
  std::vector<Registers> registers_;
  std::vector<PacketRegisters> packets_;  ///< none where rays travel alone
};

}  // namespace ctu::pipeline
