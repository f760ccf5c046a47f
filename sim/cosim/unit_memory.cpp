#include "sim/cosim/unit_memory.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "model/pipeline/memory_map.h"

namespace ctu::cosim {
namespace {

using pipeline::BankedMemory;
using pipeline::IdealMemory;

constexpr std::size_t kIds = 256;

std::variant<IdealMemory, BankedMemory> make_memory(const pipeline::MemoryConfig& config) {
  if (config.model == pipeline::MemoryModel::Banked) return BankedMemory(config);
  return IdealMemory(config);
}

}  // namespace

UnitMemory::UnitMemory(const pipeline::UnitConfig& config, const accel::Image& image, std::uint64_t behind)
    : line_bytes_(static_cast<std::size_t>(config.memory.line_bytes)),
      write_bytes_(static_cast<std::size_t>(config.stack.spill_batch *
                                            pipeline::stack_entry_bytes(image.layout.primitive_boxes))),
      bytes_(image.bytes),
      address_of_(kIds * pipeline::kClients),
      memory_(make_memory(config.memory)) {
  const std::size_t size = (image.bytes.size() + line_bytes_ - 1) / line_bytes_ * line_bytes_ + behind;
  bytes_.resize((size + line_bytes_ - 1) / line_bytes_ * line_bytes_);
}

bool UnitMemory::can_accept(pipeline::Cycle now, std::uint64_t address) const {
  if (const auto* banked = std::get_if<BankedMemory>(&memory_)) return banked->can_accept(address);
  return std::get<IdealMemory>(memory_).can_accept(now);
}

std::size_t UnitMemory::pending_place(const pipeline::ClientAnswer& answer) const {
  return static_cast<std::size_t>(answer.client) * kIds + answer.id;
}

void UnitMemory::accept(pipeline::Cycle now, const pipeline::ClientRequest& request,
                        std::span<const std::uint32_t> line) {
  const std::uint64_t address = request.request.address;
  if (request.request.write) {
    store(address, std::as_bytes(line));
  } else {
    address_of_[pending_place({request.client, request.request.id})] = address;
  }
  std::visit([&](auto& memory) { memory.accept(now, request); }, memory_);
}

void UnitMemory::store(std::uint64_t address, std::span<const std::byte> line) {
  // A unit that writes where nothing is, is wrong; what it reads later will say so.
  const std::size_t offset = address % line_bytes_;
  if (address + write_bytes_ > bytes_.size() || offset + write_bytes_ > line.size()) return;
  std::memcpy(bytes_.data() + address, line.data() + offset, write_bytes_);
}

bool UnitMemory::answer_ready(pipeline::Cycle now) const {
  return std::visit([&](const auto& memory) { return memory.answer_ready(now); }, memory_);
}

const pipeline::ClientAnswer& UnitMemory::answer() const {
  return std::visit([](const auto& memory) -> const pipeline::ClientAnswer& { return memory.answer(); }, memory_);
}

std::span<const std::uint8_t> UnitMemory::answer_line() const {
  const std::uint64_t address = address_of_[pending_place(answer())];
  // A unit that asks for what is not there gets the last line: the comparison names what is wrong.
  const std::size_t line = address / line_bytes_ * line_bytes_;
  const std::size_t first = std::min(line, bytes_.size() - line_bytes_);
  return {bytes_.data() + first, line_bytes_};
}

void UnitMemory::take_answer() {
  std::visit([](auto& memory) { memory.take_answer(); }, memory_);
}

void UnitMemory::work(pipeline::Cycle now) {
  std::visit([&](auto& memory) { return memory.work(now); }, memory_);
}

bool UnitMemory::empty() const {
  return std::visit([](const auto& memory) { return memory.empty(); }, memory_);
}

}  // namespace ctu::cosim
