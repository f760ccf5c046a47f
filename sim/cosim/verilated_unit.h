// A Verilated unit_bench.sv as an RtlUnit.
#pragma once

#include <verilated.h>
#if VM_COVERAGE
#include <verilated_cov.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

#include "model/numeric/round.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

template <class Model>
class VerilatedUnit final : public RtlUnit {
 public:
  explicit VerilatedUnit(RtlParameters parameters) : parameters_(std::move(parameters)) {}
  ~VerilatedUnit() override {
    model_.final();
#if VM_COVERAGE
    write_coverage();
#endif
  }

  const RtlParameters& parameters() const override { return parameters_; }

  void configure(const pipeline::UnitConfig& config, const ImageStraps& straps) override {
    model_.contexts_i = static_cast<std::uint16_t>(config.unit.contexts);
    model_.ray_interval_i = static_cast<std::uint8_t>(config.ray_setup.interval);
    model_.packets_i = static_cast<std::uint8_t>(config.packet_cull.packets);
    model_.packet_entries_i = static_cast<std::uint8_t>(straps.packet_entries);
    model_.packet_interval_i = static_cast<std::uint8_t>(config.packet_cull.interval);
    model_.round_robin_i = config.scheduler.policy == pipeline::SchedulerPolicy::RoundRobin;
    set_cache(0, config.node_cache, config.memory.line_bytes);
    set_cache(1, config.leaf_cache, config.memory.line_bytes);
    set_cache(2, config.table_cache, config.memory.line_bytes);
    std::copy(straps.table_base.begin(), straps.table_base.end(), &model_.table_base_i[0]);
    model_.bit_row_shift_i = static_cast<std::uint8_t>(straps.bit_row_shift);
    model_.node_base_i = straps.node_base;
    model_.node_stride_i = static_cast<std::uint16_t>(straps.node_stride);
    model_.masked_nodes_i = static_cast<std::uint32_t>(straps.masked_nodes);
    model_.bare_base_i = straps.bare_base;
    model_.bare_stride_i = static_cast<std::uint16_t>(straps.bare_stride);
    model_.full_index_i = static_cast<std::uint16_t>(straps.full_index);
    model_.triangle_base_i = straps.triangle_base;
    model_.triangle_stride_i = static_cast<std::uint16_t>(straps.triangle_stride);
    model_.triangle_interval_i = static_cast<std::uint8_t>(config.triangle_test.interval);
    model_.result_interval_i = static_cast<std::uint16_t>(config.result.interval);
    model_.stack_entries_i = static_cast<std::uint8_t>(config.stack.entries);
    model_.push_width_i = static_cast<std::uint8_t>(config.stack.push_width);
    model_.spill_batch_i = static_cast<std::uint8_t>(config.stack.spill_batch);
    model_.spill_base_i = straps.spill_base;
    model_.spill_region_i = static_cast<std::uint32_t>(straps.spill_region);
    model_.clk_i = 0;
    model_.rst_i = 1;
    for (int i = 0; i < 2; ++i) clock();
    model_.rst_i = 0;
  }

  void load_row(int table, std::uint32_t row, std::span<const std::uint64_t> words) override {
    model_.load_valid_i = 1;
    model_.load_table_i = static_cast<std::uint8_t>(table);
    model_.load_row_i = row;
    auto* data = reinterpret_cast<std::uint32_t*>(&model_.load_data_i);
    const std::size_t bytes = std::min(sizeof model_.load_data_i, words.size_bytes());
    std::memset(data, 0, sizeof model_.load_data_i);
    std::memcpy(data, words.data(), bytes);
    clock();
    model_.load_valid_i = 0;
  }

  void load_root(std::uint32_t tree, std::uint32_t root) override {
    model_.root_write_i = 1;
    model_.root_tree_i = static_cast<std::uint8_t>(tree);
    model_.root_i = root;
    clock();
    model_.root_write_i = 0;
  }

  void begin_cycle(const UnitInputs& inputs) override {
    model_.ray_valid_i = inputs.ray != nullptr;
    if (inputs.ray != nullptr) set_ray(*inputs.ray);
    model_.ray_closes_i = inputs.ray_closes;
    model_.ray_tree_i = static_cast<std::uint8_t>(inputs.ray_tree);
    model_.stall_push_i = inputs.stall_push;
    model_.stall_pop_i = inputs.stall_pop;
    model_.mem_busy_i = inputs.memory_busy;
    model_.mem_answer_valid_i = inputs.answer != nullptr;
    if (inputs.answer != nullptr) {
      model_.mem_answer_client_i = static_cast<std::uint8_t>(inputs.answer->client);
      model_.mem_answer_id_i = static_cast<std::uint8_t>(inputs.answer->id);
      std::memcpy(&model_.mem_answer_data_i, inputs.answer_line.data(),
                  std::min(sizeof model_.mem_answer_data_i, inputs.answer_line.size()));
    }
    model_.mem_can_accept_i = 0;
    model_.eval();
  }
  bool asked(pipeline::Client client, std::uint64_t& address) const override {
    const auto c = static_cast<std::size_t>(client);
    address = model_.mem_address_o[c];
    return (model_.mem_asked_o >> c & 1) != 0;
  }
  void settle(unsigned can_accept) override {
    model_.mem_can_accept_i = static_cast<std::uint8_t>(can_accept);
    model_.eval();
  }
  void end_cycle() override {
    model_.clk_i = 1;
    model_.eval();
    model_.clk_i = 0;
  }

  RtlRequest request() const override {
    RtlRequest request;
    request.valid = model_.mem_request_valid_o;
    if (!request.valid) return request;
    request.request = {static_cast<pipeline::Client>(model_.mem_request_client_o),
                       {model_.mem_request_address_o, model_.mem_request_id_o, model_.mem_request_write_o != 0}};
    const auto* words = reinterpret_cast<const std::uint32_t*>(&model_.mem_request_data_o);
    if (request.request.request.write)
      request.line.assign(words, words + sizeof model_.mem_request_data_o / sizeof *words);
    return request;
  }
  bool answer_taken() const override { return model_.mem_answer_take_o; }
  bool ray_taken(pipeline::Slot& slot) const override {
    slot = model_.ray_slot_o;
    return model_.ray_take_o;
  }
  ReturnedRay returned() const override {
    const auto number = [&](std::size_t word) { return numeric::from_bits(model_.return_hit_o[word]); };
    return {
        model_.return_valid_o != 0, model_.return_slot_o, {number(3), number(2), number(1), model_.return_hit_o[0]}};
  }
  bool row_left_out(pipeline::Slot& slot) const override {
    slot = model_.row_left_out_slot_o;
    return model_.row_left_out_o;
  }
  LinkState link(int number) const override {
    const auto bit = [number](std::uint64_t bits) { return (bits >> number & 1) != 0; };
    LinkState state{
        bit(model_.link_valid_o), bit(model_.link_ready_o), bit(model_.link_pop_o), bit(model_.link_push_o), {}};
    if (state.pushed)
      for (std::size_t word = 0; word < kTokenWords; ++word)
        state.token[word] = model_.link_data_o[static_cast<std::size_t>(number)][word];
    return state;
  }
  int activity(int stage) const override { return model_.activity_o[static_cast<std::size_t>(stage)]; }

 private:
  /// A whole clock outside of a run, where nobody has looked at the low half of it.
  void clock() {
    model_.eval();
    end_cycle();
  }
  void set_cache(std::size_t cache, const pipeline::CacheConfig& config, int line_bytes) {
    const int lines = config.bytes / line_bytes;
    model_.cache_ways_i[cache] = static_cast<std::uint8_t>(lines == 0 ? 0 : config.ways);
    model_.cache_sets_i[cache] = static_cast<std::uint16_t>(lines == 0 ? 0 : lines / config.ways);
    model_.cache_mshrs_i[cache] = static_cast<std::uint8_t>(config.mshrs);
    model_.cache_hit_latency_i[cache] = static_cast<std::uint8_t>(config.hit_latency);
  }
  void set_ray(const intersect::Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      model_.ray_origin_i[axis] = numeric::bits(ray.origin[axis]);
      model_.ray_direction_i[axis] = numeric::bits(ray.direction[axis]);
    }
    model_.ray_tmin_i = numeric::bits(ray.tmin);
    model_.ray_tmax_i = numeric::bits(ray.tmax);
    model_.ray_any_hit_i = ray.kind == intersect::RayKind::AnyHit;
  }

#if VM_COVERAGE
  /// Into the folder that CTU_COVERAGE names, a file for each unit of the process.
  void write_coverage() {
    static int units = 0;
    const char* const folder = std::getenv("CTU_COVERAGE");
    if (folder == nullptr) return;
    const std::string file = std::string(folder) + "/" + parameters_.name + "-" + std::to_string(units++) + ".dat";
    context_.coveragep()->write(file.c_str());
  }
#endif

  RtlParameters parameters_;
  VerilatedContext context_;
  Model model_{&context_};
};

}  // namespace ctu::cosim
