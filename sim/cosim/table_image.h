// The design's tables on their way into the RTL unit: row by row through its load port, or into memory when they lie
// behind table_cache.
#pragma once

#include <cstdint>
#include <span>

#include "model/cull/table_content.h"
#include "model/pipeline/table_lines.h"
#include "model/pipeline/work.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

/// What the unit knows of the image and of the packets of the work's rays, without arithmetic.
pipeline::UnitImage image_of(const pipeline::Work& work);

/// Whether the design has tables and they lie behind table_cache.
bool has_table_fetch(const pipeline::UnitConfig& config, const pipeline::Work& work);

/// Where cached tables lie.
void strap_tables(ImageStraps& straps, const pipeline::UnitConfig& config, const pipeline::Work& work);

/// Bytes of spilled stack entries and, where tables are cached, of tables.
std::uint64_t bytes_behind_image(const pipeline::UnitConfig& config, const pipeline::Work& work);

/// Writes all rows where the layout has them, the lowest bits in the first byte.
void write_tables(std::span<std::uint8_t> memory, const pipeline::TableLayout& layout,
                  const cull::TableContent& content);

/// `memory` is that of the whole run, the image first: where cached tables go.
void load_tables(RtlUnit& unit, std::span<std::uint8_t> memory, const pipeline::UnitConfig& config,
                 const pipeline::Work& work);

}  // namespace ctu::cosim
