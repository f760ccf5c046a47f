// What lies where in memory behind the image: spilled stack entries, then tables too large for the chip.
#pragma once

#include <cstdint>

#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

inline constexpr int kStackEntryBytes = 8;  ///< reference and t0

/// Byte addresses; every part begins a line.
struct MemoryMap {
  MemoryMap(const UnitConfig& config, const UnitImage& image)
      : line_bytes(static_cast<std::uint64_t>(config.memory.line_bytes)),
        spill_base(round_up(image.end())),
        spill_region(round_up((static_cast<std::uint64_t>(image.stack_bound()) + 1) * kStackEntryBytes)),
        table_base(spill_base + static_cast<std::uint64_t>(config.unit.contexts) * spill_region) {}

  std::uint64_t round_up(std::uint64_t bytes) const { return (bytes + line_bytes - 1) / line_bytes * line_bytes; }

  std::uint64_t line_bytes;
  std::uint64_t spill_base;
  std::uint64_t spill_region;  ///< bytes of each context
  std::uint64_t table_base;
};

}  // namespace ctu::pipeline
