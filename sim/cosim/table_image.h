// The design's tables on their way into the RTL unit: row by row through its load port, or into memory when they lie
// behind table_cache.
#pragma once

#include <cstdint>
#include <span>

#include "model/pipeline/work.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

/// Bytes of spilled stack entries and, where tables are cached, of tables.
std::uint64_t bytes_behind_image(const pipeline::UnitConfig& config, const pipeline::Work& work);

/// `memory` is that of the whole run, the image first.
void load_tables(RtlUnit& unit, std::span<std::uint8_t> memory, const pipeline::UnitConfig& config,
                 const pipeline::Work& work);

}  // namespace ctu::cosim
