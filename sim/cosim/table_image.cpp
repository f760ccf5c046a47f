#include "sim/cosim/table_image.h"

#include <cstring>

#include "model/pipeline/memory_map.h"
#include "model/pipeline/unit_image.h"

namespace ctu::cosim {
namespace {

cull::OnChipTables tables_of(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  return {work.tester, config.mask_test.rows, config.mask_test.projection_tables};
}

pipeline::TableLayout layout_of(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  const pipeline::UnitImage image = image_of(work);
  return {config, tables_of(config, work), pipeline::MemoryMap(config, image), image.compressed()};
}

void load_on_chip(RtlUnit& unit, const cull::TableContent& content) {
  for (std::size_t table = 0; table < content.tables().size(); ++table)
    for (std::uint64_t row = 0; row < content.tables()[table].rows; ++row)
      unit.load_row(static_cast<int>(table), static_cast<std::uint32_t>(row),
                    {content.row(table, row), content.words(table)});
}

}  // namespace

pipeline::UnitImage image_of(const pipeline::Work& work) {
  return {work.image, work.tester, false, work.rays.packets().most_entries};
}

bool has_table_fetch(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  return config.table_cache.bytes > 0 && !tables_of(config, work).tables().empty();
}

void strap_tables(ImageStraps& straps, const pipeline::UnitConfig& config, const pipeline::Work& work) {
  if (!has_table_fetch(config, work)) return;
  const pipeline::TableLayout layout = layout_of(config, work);
  for (std::size_t table = 0; table < tables_of(config, work).tables().size(); ++table) {
    straps.table_base[table] = layout.base(table);
    if (layout.is_read_by_bit(table)) straps.bit_row_shift = layout.stride_shift(table);
  }
}

std::uint64_t bytes_behind_image(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  const pipeline::MemoryMap map(config, image_of(work));
  const std::uint64_t end = has_table_fetch(config, work) ? layout_of(config, work).end() : map.table_base;
  return end - map.round_up(work.image.bytes.size());
}

void write_tables(std::span<std::uint8_t> memory, const pipeline::TableLayout& layout,
                  const cull::TableContent& content) {
  for (std::size_t table = 0; table < content.tables().size(); ++table) {
    const std::size_t bytes = (content.tables()[table].row_bits + 7) / 8;
    for (std::uint64_t row = 0; row < content.tables()[table].rows; ++row)
      std::memcpy(memory.data() + layout.base(table) + (row << layout.stride_shift(table)), content.row(table, row),
                  bytes);
  }
}

void load_tables(RtlUnit& unit, std::span<std::uint8_t> memory, const pipeline::UnitConfig& config,
                 const pipeline::Work& work) {
  if (tables_of(config, work).tables().empty()) return;
  const cull::TableContent content(work.tester, config.mask_test.rows, config.mask_test.projection_tables);
  if (config.table_cache.bytes == 0)
    load_on_chip(unit, content);
  else
    write_tables(memory, layout_of(config, work), content);
}

}  // namespace ctu::cosim
