#include "sim/cosim/rtl_run.h"

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/cosim/table_image.h"

namespace ctu::cosim {
namespace {

using pipeline::Client;

constexpr std::size_t kWrongHitsKept = 16;

ImageStraps straps_of(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  const pipeline::MemoryMap map(config, image_of(work));
  const accel::Image& image = work.image;
  ImageStraps straps;
  straps.node_base = image.node_base;
  straps.node_stride = image.node_stride_bytes;
  straps.masked_nodes = image.masked_nodes();
  straps.bare_base = image.node_address(image.masked_nodes());
  straps.bare_stride = image.bare_node_stride_bytes;
  straps.triangle_base = image.triangle_base;
  straps.triangle_stride = image.triangle_stride_bytes;
  straps.spill_base = map.spill_base;
  straps.spill_region = map.spill_region;
  if (const cull::CompressionLut* lut = work.tester.compression_lut())
    straps.full_index = static_cast<std::uint64_t>(lut->entries() - 1);
  straps.packet_entries = work.rays.packets().most_entries;
  strap_tables(straps, config, work);
  return straps;
}

}  // namespace

RtlRun::RtlRun(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& work,
               const pipeline::Backpressure& stalls, const std::array<int, kLinks>& stall_numbers)
    : unit_(unit),
      feed_(work.rays),
      memory_(config, work.image, bytes_behind_image(config, work)),
      stalls_(stalls),
      stall_numbers_(stall_numbers),
      in_slot_(static_cast<std::size_t>(config.unit.contexts)) {
  unit_.configure(config, straps_of(config, work));
  load_tables(unit_, memory_.bytes(), config, work);
  if (unit_.parameters().trees > 1)
    for (std::uint32_t tree = 0; tree < work.image.trees(); ++tree) unit_.load_root(tree, work.image.root(tree));
  next_block();
}

void RtlRun::next_block() {
  index_ = packet_ = 0;
  do {
    block_ = feed_.next();
  } while (block_ != nullptr && block_->rays.empty());
}

bool RtlRun::ray_closes() const {
  return block_ != nullptr && feed_.packets().any() && index_ + 1 == block_->packets.first_ray[packet_ + 1];
}

std::uint64_t RtlRun::stalled(pipeline::Side side) const {
  if (!stalls_.any()) return 0;
  std::uint64_t links = 0;
  for (int link = 0; link < kLinks; ++link) {
    const int number = stall_numbers_[static_cast<std::size_t>(link)];
    if (number >= 0 && stalls_.refuses(number, side, now_)) links |= std::uint64_t{1} << link;
  }
  return links;
}

void RtlRun::begin() {
  UnitInputs inputs;
  inputs.ray = next_ray();
  inputs.ray_closes = ray_closes();
  if (inputs.ray != nullptr) inputs.ray_tree = reference::tree_of(block_->trees, index_);
  inputs.stall_push = stalled(pipeline::Side::Push);
  inputs.stall_pop = stalled(pipeline::Side::Pop);
  inputs.memory_busy = !memory_.empty();
  if (memory_.answer_ready(now_)) {
    inputs.answer = &memory_.answer();
    inputs.answer_line = memory_.answer_line();
  }
  unit_.begin_cycle(inputs);

  unsigned can_accept = 0;
  for (int client = 0; client < pipeline::kClients; ++client) {
    std::uint64_t address = 0;
    if (unit_.asked(static_cast<Client>(client), address) && memory_.can_accept(now_, address))
      can_accept |= 1u << client;
  }
  unit_.settle(can_accept);
  if (unit_.answer_taken()) memory_.take_answer();
  const RtlRequest request = unit_.request();
  if (request.valid) memory_.accept(now_, request.request, request.line);
  memory_.work(now_);
}

void RtlRun::end() {
  pipeline::Slot slot = 0;
  if (unit_.ray_taken(slot)) take_ray(slot);
  if (unit_.row_left_out(slot)) throw_row_left_out(slot);
  const ReturnedRay returned = unit_.returned();
  if (returned.valid) give_back(returned);
  unit_.end_cycle();
  ++now_;
}

void RtlRun::throw_row_left_out(pipeline::Slot slot) const {
  throw Error(fmt::format("ray {}, cycle {}", slot < in_slot_.size() ? in_slot_[slot].number : 0, now_),
              "begins inside a box, and mask_test.rows = reachable leaves out the table rows of such rays",
              "choose mask_test.rows = folded");
}

void RtlRun::take_ray(pipeline::Slot slot) {
  if (block_ == nullptr || slot >= in_slot_.size()) return;
  in_slot_[slot] = {block_->first_ray + index_, block_->expected[index_]};
  ++taken_;
  packet_ += ray_closes();
  if (++index_ == block_->rays.size()) next_block();
}

void RtlRun::give_back(const ReturnedRay& returned) {
  if (returned.slot >= in_slot_.size()) return;
  const RayInSlot& ray = in_slot_[returned.slot];
  ++returned_;
  if (intersect::same_bits(returned.hit, ray.expected)) return;
  ++wrong_hits_;
  if (first_wrong_.size() < kWrongHitsKept) first_wrong_.push_back({ray.number, ray.expected, returned.hit});
}

}  // namespace ctu::cosim
