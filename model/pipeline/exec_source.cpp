#include "model/pipeline/exec_source.h"

#include <algorithm>
#include <bit>

#include "model/cull/bit_rows.h"
#include "model/cull/leaf_culling.h"
#include "model/intersect/slab_test.h"
#include "model/intersect/sphere_test.h"
#include "model/intersect/triangle_test.h"

namespace ctu::pipeline {

using cull::Design;

ExecSource::ExecSource(const UnitConfig& config, const UnitImage& image, const cull::MaskTester& tester,
                       Contexts& contexts)
    : image_(image),
      contexts_(contexts),
      tester_(tester),
      design_(config.mask_test.design),
      resolution_(tester.options().resolution),
      ray_resolution_(tester.options().ray_resolution),
      words_(cull::words_per_mask(tester.options().resolution)),
      reads_bit_rows_(design_ == Design::BitTable || (design_ == Design::Dedup && image.compressed())),
      registers_(static_cast<std::size_t>(contexts.count())),
      packets_(image.packet_entries() > 0 ? static_cast<std::size_t>(config.packet_cull.packets) : 0) {}

bool ExecSource::begin(Slot slot) {
  const Context& context = contexts_[slot];
  Registers& r = registers_[slot];
  const reference::StepList& list = context.block->steps;
  r.ray = intersect::prepare_ray(context.block->rays[context.index]);
  r.best = {};
  r.best.t = r.ray.ray.tmax;
  r.dropped = 0;
  r.recorded = r.recorded_end = nullptr;
  r.recorded_met = r.recorded_met_end = nullptr;
  if (context.index < list.rays()) {
    r.recorded = list.steps.data() + list.first_step[context.index];
    r.recorded_end = list.steps.data() + list.first_step[context.index + 1];
    r.recorded_tail = list.tail_dropped[context.index];
    if (image_.primitive_boxes()) {
      r.recorded_met = list.met.data() + list.first_met[context.index];
      r.recorded_met_end = list.met.data() + list.first_met[context.index + 1];
    }
  }
  return r.ray.valid;
}

void ExecSource::open_packet(int packet, Slot leader) {
  const Context& context = contexts_[leader];
  const bool recorded = context.block->packets.walked();
  packets_[static_cast<std::size_t>(packet)] = {{}, recorded ? context.block : nullptr, context.packet, 0};
}

void ExecSource::join_packet(int packet, Slot slot) {
  packets_[static_cast<std::size_t>(packet)].slabs.add(registers_[slot].ray);
}

cull::packet::PacketTimes ExecSource::packet_test(int packet, std::uint32_t node) {
  PacketRegisters& r = packets_[static_cast<std::size_t>(packet)];
  const cull::packet::PacketTimes times = r.slabs.test(image_.boxes(node));
  if (r.block == nullptr) return times;
  const reference::PacketList& list = r.block->packets;
  const std::uint64_t visit = list.first_visit[r.number] + r.visits++;
  if (visit >= list.first_visit[r.number + 1] ||
      !(list.visits[visit] == reference::PacketVisit{node, static_cast<std::uint8_t>(times.hit | times.sure << 4)}))
    ++event_mismatches_;
  return times;
}

reference::EntryList ExecSource::packet_entries(int packet, const reference::EntryList& found) {
  const PacketRegisters& r = packets_[static_cast<std::size_t>(packet)];
  if (r.block == nullptr) return found;
  const reference::PacketList& list = r.block->packets;
  const std::uint64_t first = list.first_entry[r.number], count = list.first_entry[r.number + 1] - first;
  bool same = count == static_cast<std::uint64_t>(found.count());
  for (int i = 0; same && i < found.count(); ++i)
    same = found[i].ref == list.entries[first + static_cast<std::uint64_t>(i)];
  if (!same || list.first_visit[r.number] + r.visits != list.first_visit[r.number + 1]) ++event_mismatches_;
  return found;
}

void ExecSource::visit(Slot slot, accel::ChildRef ref) {
  Registers& r = registers_[slot];
  r.step = {ref, r.dropped, 0, 0};
  r.dropped = 0;
}

std::uint8_t ExecSource::box_test(Slot slot, accel::ChildRef node) {
  Registers& r = registers_[slot];
  if (design_ == Design::None)
    intersect::slab_test_outer(r.ray, image_.boxes(node), r.best.t, r.times);
  else
    r.times = intersect::slab_test(r.ray, image_.boxes(node), r.best.t);
  r.step.lanes = static_cast<std::uint8_t>(r.times.hit | (r.times.hit << 4));
  return r.times.hit;
}

std::uint8_t ExecSource::locate(Slot slot, unsigned hits) {
  Registers& r = registers_[slot];
  const intersect::Box4& boxes = image_.boxes(r.step.ref);
  const unsigned asked = hits & ~image_.full_lanes(r.step.ref);
  for (unsigned rest = asked; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    if (design_ == Design::Comparators)
      cull::comparator_mask(r.ray, r.times, boxes, lane, resolution_, r.touched[lane]);
    else
      r.key[lane] = cull::cell_locate(r.ray, r.times, boxes, lane, ray_resolution_).packed;
  }
  return static_cast<std::uint8_t>(asked);
}

LaneKeys ExecSource::keys(const NodeToken& token) const {
  const Registers& r = registers_[token.slot];
  LaneKeys keys;
  for (unsigned rest = token.asked; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    keys.key[keys.count] = r.key[lane];
    if (image_.compressed()) keys.mask_index[keys.count] = image_.mask_index(r.step.ref, lane);
    ++keys.count;
  }
  return keys;
}

const std::uint64_t* ExecSource::ray_mask(const Registers& r, int lane, std::uint64_t* projected) const {
  const cull::CellKey key{r.key[lane]};
  switch (design_) {
    case Design::MaskLut:
      return tester_.ray_mask_table()->row(tester_.ray_mask_table()->row_index(key));
    case Design::Dedup:
      return tester_.dedup_table()->row(tester_.dedup_table()->id(cull::key_number(key, ray_resolution_)));
    case Design::Projection:
      tester_.projection_table()->ray_mask(key, projected);
      return projected;
    default:
      return r.touched[lane];
  }
}

const std::uint64_t* ExecSource::bit_row(const Registers& r, int lane) const {
  const std::uint32_t key = cull::key_number(cull::CellKey{r.key[lane]}, ray_resolution_);
  if (design_ == Design::BitTable) return tester_.bit_table()->row(key);
  return tester_.dedup_table()->row(tester_.dedup_table()->id(key));
}

bool ExecSource::passes(const Registers& r, int lane) const {
  if (reads_bit_rows_) return cull::bit_of_row(bit_row(r, lane), image_.mask_index(r.step.ref, lane));
  std::uint64_t projected[kMaxWords];
  const std::uint64_t* const ray_mask_words = ray_mask(r, lane, projected);
  const std::uint64_t* const object_mask = image_.mask(r.step.ref, lane);
  std::uint64_t common = 0;
  for (int word = 0; word < words_; ++word) common |= ray_mask_words[word] & object_mask[word];
  return common != 0;
}

MaskAnswer ExecSource::mask_test(const NodeToken& token) {
  Registers& r = registers_[token.slot];
  MaskAnswer answer;
  answer.survivors = static_cast<std::uint8_t>(token.hits & ~token.asked);
  for (unsigned rest = token.asked; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto bit = static_cast<std::uint8_t>(1u << lane);
    const bool uncertain = design_ != Design::Comparators && cull::CellKey{r.key[lane]}.uncertain();
    if (uncertain) answer.uncertain |= bit;
    if (uncertain || passes(r, lane)) answer.survivors |= bit;
  }
  r.step.lanes = static_cast<std::uint8_t>(token.hits | (static_cast<unsigned>(answer.survivors) << 4));
  r.step.detail = static_cast<std::uint16_t>(static_cast<unsigned>(answer.uncertain) << 8);
  return answer;
}

std::uint8_t ExecSource::child_order(Slot slot, unsigned survivors) {
  Registers& r = registers_[slot];
  // The place of a lane is the number of survivors before it by (t0, lane): what six comparators give at once.
  unsigned order = 0;
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    if (((survivors >> lane) & 1u) == 0) continue;
    int place = 0;
    for (int other = 0; other < intersect::kLanes; ++other)
      if (other != lane && ((survivors >> other) & 1u) != 0)
        place += other < lane ? r.times.t0[other] <= r.times.t0[lane] : r.times.t0[other] < r.times.t0[lane];
    order |= static_cast<unsigned>(lane) << (2 * place);
  }
  r.step.detail = static_cast<std::uint16_t>(r.step.detail | order);
  return static_cast<std::uint8_t>(order);
}

void ExecSource::pushed(Slot slot, int position, int lane) {
  Registers& r = registers_[slot];
  r.stack_t0[position] = r.times.t0[lane];
  if (image_.primitive_boxes()) r.stack_t1[position] = r.times.t1[lane];
}

void ExecSource::goes_to_child(Slot slot, int lane) {
  if (!image_.primitive_boxes()) return;
  Registers& r = registers_[slot];
  r.t0 = r.times.t0[lane];
  r.t1 = r.times.t1[lane];
}

void ExecSource::goes_to_entry(Slot slot, int position) {
  if (!image_.primitive_boxes()) return;
  Registers& r = registers_[slot];
  r.t0 = r.stack_t0[position];
  r.t1 = r.stack_t1[position];
}

bool ExecSource::drops(Slot slot, int position) {
  Registers& r = registers_[slot];
  if (r.stack_t0[position] <= r.best.t) return false;
  ++r.dropped;
  return true;
}

std::uint16_t ExecSource::primitive_cull(Slot slot, accel::ChildRef leaf) {
  Registers& r = registers_[slot];
  const auto box_of = [&](std::uint32_t i) { return image_.primitive_box(accel::leaf_first(leaf) + i); };
  const auto count = static_cast<std::uint32_t>(accel::leaf_count(leaf));
  const auto met =
      static_cast<std::uint16_t>(cull::boxes_met(r.ray.ray, r.t0, std::min(r.t1, r.best.t), count, box_of));
  if (r.recorded_met != nullptr) {
    if (r.recorded_met == r.recorded_met_end || *r.recorded_met != met) ++event_mismatches_;
    if (r.recorded_met != r.recorded_met_end) ++r.recorded_met;
  }
  return met;
}

ExecSource::Test ExecSource::triangle_test(Slot slot, accel::ChildRef leaf, int index, bool last) {
  // The tests of a leaf are under way together, so all see the best hit from before the leaf. The outcome is the same
  // as with the best hit of the moment: what lies beyond it does not replace it.
  const Registers& r = registers_[slot];
  const accel::LeafTriangle& triangle = image_.triangle(accel::leaf_first(leaf) + static_cast<unsigned>(index));
  if (triangle.is_sphere()) return {slot, static_cast<std::uint8_t>(index), last, false, {0, 0, 0, triangle.primitive}};
  const auto result = intersect::triangle_test(r.ray, triangle.v0, triangle.v1, triangle.v2, r.best.t);
  return {slot, static_cast<std::uint8_t>(index), last, result.hit, {result.t, result.u, result.v, triangle.primitive}};
}

ExecSource::Test ExecSource::sphere_test(const Test& test) {
  if (!test.is_sphere()) return test;
  const Registers& r = registers_[test.slot];
  const accel::LeafTriangle& primitive = image_.triangle(accel::leaf_first(r.step.ref) + test.index);
  const intersect::SphereResult result = intersect::sphere_test(r.ray, primitive.sphere(), r.best.t);
  return {test.slot, test.index, test.last, result.hit, {result.t, 0, 0, primitive.id()}};
}

void ExecSource::update(const Test& test) {
  Registers& r = registers_[test.slot];
  ++r.step.lanes;  // primitives tested
  if (!test.hit || !intersect::replaces(test.candidate.t, test.candidate.primitive, r.best)) return;
  r.best = test.candidate;
  r.step.detail = static_cast<std::uint16_t>(r.step.detail | (1u << test.index));
}

reference::Step ExecSource::finish_visit(Slot slot) {
  Registers& r = registers_[slot];
  if (r.recorded != nullptr) {
    if (r.recorded == r.recorded_end || !(*r.recorded == r.step)) ++event_mismatches_;
    if (r.recorded != r.recorded_end) ++r.recorded;
  }
  return r.step;
}

intersect::Hit ExecSource::finish(Slot slot, const accel::Image&) {
  const Registers& r = registers_[slot];
  if (r.recorded != nullptr && (r.recorded != r.recorded_end || r.dropped != r.recorded_tail)) ++event_mismatches_;
  return r.best;
}

}  // namespace ctu::pipeline
