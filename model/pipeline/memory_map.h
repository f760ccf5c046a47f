// What lies where in memory behind the image: spilled stack entries, then tables too large for the chip.
#pragma once

#include <cstdint>

#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

/// Bits of a stack entry on chip: reference and t0; t1 too where ray boxes cull primitives.
inline int stack_entry_bits(const UnitImage& image) { return image.primitive_boxes() ? 96 : 64; }
/// Bytes of a stack entry in memory, a power of two.
inline int stack_entry_bytes(bool primitive_boxes) { return primitive_boxes ? 16 : 8; }

/// Byte addresses; every part begins a line.
struct MemoryMap {
  MemoryMap(const UnitConfig& config, const UnitImage& image)
      : line_bytes(static_cast<std::uint64_t>(config.memory.line_bytes)),
        entry_bytes(static_cast<std::uint64_t>(stack_entry_bytes(image.primitive_boxes()))),
        spill_base(round_up(image.end())),
        spill_region(round_up((static_cast<std::uint64_t>(image.stack_bound()) + 1) * entry_bytes)),
        table_base(spill_base + static_cast<std::uint64_t>(config.unit.contexts) * spill_region) {}

  std::uint64_t round_up(std::uint64_t bytes) const { return (bytes + line_bytes - 1) / line_bytes * line_bytes; }

  std::uint64_t line_bytes;
  std::uint64_t entry_bytes;  ///< of the stack
  std::uint64_t spill_base;
  std::uint64_t spill_region;  ///< bytes of each context
  std::uint64_t table_base;
};

}  // namespace ctu::pipeline
