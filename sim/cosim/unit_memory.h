// Memory behind the RTL unit's port: the model's timing (model/pipeline/memory_*.h) with bytes in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "model/accel/image.h"
#include "model/pipeline/memory_banked.h"
#include "model/pipeline/memory_ideal.h"

namespace ctu::cosim {

class UnitMemory {
 public:
  /// The image from address 0 on, and `behind` more bytes for the stack's spills and for tables.
  UnitMemory(const pipeline::UnitConfig& config, const accel::Image& image, std::uint64_t behind);

  bool can_accept(pipeline::Cycle now, std::uint64_t address) const;
  /// Takes a request. A write stores a batch of stack entries, which lies in `line` where it goes in memory's line.
  void accept(pipeline::Cycle now, const pipeline::ClientRequest& request, std::span<const std::uint32_t> line);
  bool answer_ready(pipeline::Cycle now) const;
  const pipeline::ClientAnswer& answer() const;
  /// The line of the answer that is ready.
  std::span<const std::uint8_t> answer_line() const;
  void take_answer();
  /// One cycle of memory itself, behind what was accepted and taken in it.
  void work(pipeline::Cycle now);
  bool empty() const;

  /// Bytes that a host writes before the run.
  std::span<std::uint8_t> bytes() { return bytes_; }

 private:
  void store(std::uint64_t address, std::span<const std::byte> line);
  std::size_t pending_place(const pipeline::ClientAnswer& answer) const;

  std::size_t line_bytes_, write_bytes_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint64_t> address_of_;  // of the reads under way, by client and id
  std::variant<pipeline::IdealMemory, pipeline::BankedMemory> memory_;
};

}  // namespace ctu::cosim
