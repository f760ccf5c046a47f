// A Verilated fetch_bench.sv beside the model's node_fetch and leaf_fetch: every handshake and account in every cycle,
// and the bytes that each context gets.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {

template <class Model>
class VerilatedFetch {
 public:
  VerilatedFetch(const accel::Image& image, const pipeline::UnitConfig& config, std::uint64_t full_mask)
      : image_(image), line_bytes_(static_cast<std::size_t>(config.memory.line_bytes)), full_mask_(full_mask) {
    set_cache(0, config.node_cache);
    set_cache(1, config.leaf_cache);
    twin_.node_base_i = static_cast<std::uint32_t>(image.node_base);
    twin_.node_stride_i = static_cast<std::uint16_t>(image.node_stride_bytes);
    twin_.masked_nodes_i = image.masked_nodes();
    twin_.bare_base_i = static_cast<std::uint32_t>(image.node_address(image.masked_nodes()));
    twin_.bare_stride_i = static_cast<std::uint16_t>(image.bare_node_stride_bytes);
    twin_.full_mask_i = full_mask;
    twin_.triangle_base_i = static_cast<std::uint32_t>(image.triangle_base);
    twin_.triangle_stride_i = static_cast<std::uint16_t>(image.triangle_stride_bytes);
    reset(twin_);
  }

  /// One cycle beside the model's; what differs.
  template <class NodeFetch, class LeafFetch>
  std::string cycle(NodeFetch& node_fetch, LeafFetch& leaf_fetch) {
    drive(0, node_fetch);
    drive(1, leaf_fetch);
    twin_.eval();
    compare(0, node_fetch);
    compare(1, leaf_fetch);
    // A context's bytes are still there when its next ones are asked for.
    if (node_fetch.requests.popped) check_node(node_of_[node_fetch.requests.token.slot], 1);
    if (leaf_fetch.requests.popped) check_leaf(leaf_of_[leaf_fetch.requests.token.slot]);
    clock(twin_);
    if (node_fetch.done.pushed) check_node(node_of_[node_fetch.done.token.slot] = node_fetch.done.token, 0);
    if (leaf_fetch.done.pushed) check_leaf(leaf_of_[leaf_fetch.done.token.slot] = leaf_fetch.done.token);
    return difference_.take();
  }

  std::uint64_t nodes = 0, leaves = 0;  ///< whose bytes were compared

 private:
  void set_cache(int stage, const pipeline::CacheConfig& cache) {
    const auto lines = static_cast<std::size_t>(cache.bytes) / line_bytes_;
    twin_.ways_i[stage] = static_cast<std::uint8_t>(lines == 0 ? 0 : cache.ways);
    twin_.set_mask_i[stage] =
        static_cast<std::uint16_t>(lines == 0 ? 0 : lines / static_cast<std::size_t>(cache.ways) - 1);
    twin_.mshrs_i[stage] = static_cast<std::uint8_t>(cache.mshrs);
    twin_.hit_latency_i[stage] = static_cast<std::uint8_t>(cache.hit_latency);
  }

  template <class Token>
  static std::uint64_t bits_of(const Token& token) {
    return static_cast<std::uint64_t>(token.slot) << 32 | token.ref;
  }
  static std::uint64_t bits_of(const pipeline::MemoryRequest& request) {
    return request.address << 9 | static_cast<std::uint64_t>(request.id) << 1 | request.write;
  }

  template <class Stage>
  void drive(int stage, const Stage& model) {
    twin_.requests_valid_i[stage] = model.requests.valid;
    twin_.requests_data_i[stage] = bits_of(model.requests.token);
    twin_.fills_valid_i[stage] = model.fills.valid;
    if (model.fills.valid) {
      const std::uint16_t id = model.fills.token.id;
      BitWriter fill(&twin_.fills_data_i[stage][0]);
      for (std::size_t i = 0; i < line_bytes_; ++i) fill.put(byte(address_of_[stage][id] + i), 8);
      fill.put(id, 8);
    }
    twin_.misses_ready_i[stage] = model.misses.ready;
    twin_.done_ready_i[stage] = model.done.ready;
  }

  template <class Stage>
  void compare(int stage, const Stage& model) {
    static constexpr const char* kNames[2][7] = {{"node requests pop", "node fills pop", "node misses push",
                                                  "node done push", "node activity", "node miss", "node done"},
                                                 {"leaf requests pop", "leaf fills pop", "leaf misses push",
                                                  "leaf done push", "leaf activity", "leaf miss", "leaf done"}};
    const auto& name = kNames[stage];
    difference_.same(name[0], twin_.requests_pop_o[stage], model.requests.popped)
        .same(name[1], twin_.fills_pop_o[stage], model.fills.popped)
        .same(name[2], twin_.misses_push_o[stage], model.misses.pushed)
        .same(name[3], twin_.done_push_o[stage], model.done.pushed)
        .same(name[4], twin_.activity_o[stage], static_cast<unsigned>(model.account.current()));
    if (model.misses.pushed) {
      difference_.same(name[5], twin_.misses_data_o[stage], bits_of(model.misses.token));
      address_of_[stage][model.misses.token.id] = model.misses.token.address;
    }
    if (model.done.pushed) difference_.same(name[6], twin_.done_data_o[stage], bits_of(model.done.token));
  }

  std::uint8_t byte(std::uint64_t address) const {
    return address < image_.bytes.size() ? image_.bytes[address] : std::uint8_t{0xA5};
  }
  std::uint32_t word(std::uint64_t address) const {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(byte(address + i)) << (8 * i);
    return value;
  }

  void check_node(const pipeline::RefToken& token, int port) {
    if (token.ref == accel::kEmptyChild) return;  // the context has fetched nothing yet
    twin_.node_slot_i[port] = static_cast<std::uint8_t>(token.slot);
    twin_.eval();
    const std::uint64_t address = image_.node_address(token.ref);
    BitReader boxes(&twin_.node_boxes_o[port][0]), children(&twin_.node_children_o[port][0]),
        masks(&twin_.node_masks_o[port][0]);
    for (unsigned i = 0; i < 24; ++i) difference_.same("bounds", boxes.take(32), word(address + 4 * i));
    for (unsigned i = 0; i < 4; ++i) difference_.same("child", children.take(32), word(address + 96 + 4 * i));
    const bool bare = token.ref >= image_.masked_nodes();
    unsigned full = 0;
    for (int lane = 0; lane < 4; ++lane) {
      std::uint64_t mask = full_mask_;
      if (image_.layout.mask_bits == 0)
        mask = 0;
      else if (!bare)
        accel::read_mask(image_, token.ref, lane, &mask);
      difference_.same("mask", masks.take(64), mask);
      full |= static_cast<unsigned>(full_mask_ != 0 && mask == full_mask_) << lane;
    }
    difference_.same("full lanes", twin_.node_full_o[port], full);
    ++nodes;
  }

  template <class Token>
  void check_leaf(const Token& token) {
    if (token.ref == accel::kEmptyChild) return;
    twin_.triangle_slot_i = static_cast<std::uint8_t>(token.slot);
    for (unsigned i = 0; i < static_cast<unsigned>(accel::leaf_count(token.ref)); ++i) {
      twin_.triangle_index_i = static_cast<std::uint8_t>(i);
      twin_.eval();
      const std::uint64_t address = image_.triangle_address(accel::leaf_first(token.ref) + i);
      BitReader vertices(&twin_.triangle_vertices_o[0]);
      for (unsigned v = 0; v < 9; ++v) difference_.same("vertex", vertices.take(32), word(address + 4 * v));
      difference_.same("primitive", twin_.triangle_primitive_o, word(address + 36));
    }
    ++leaves;
  }

  VerilatedContext context_;
  Model twin_{from_noise(context_)};
  const accel::Image& image_;
  std::size_t line_bytes_;
  std::uint64_t full_mask_;
  Difference difference_;
  std::uint64_t address_of_[2][pipeline::kMaxMissRegisters] = {};
  std::vector<pipeline::RefToken> node_of_{pipeline::kMaxContexts, {accel::kEmptyChild, 0}};
  std::vector<pipeline::LeafToken> leaf_of_{pipeline::kMaxContexts, {accel::kEmptyChild, 0}};
};

}  // namespace ctu::rtl
