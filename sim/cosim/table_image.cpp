#include "sim/cosim/table_image.h"

#include "model/cull/table_content.h"
#include "model/pipeline/memory_map.h"
#include "model/pipeline/table_lines.h"

namespace ctu::cosim {
namespace {

cull::TableContent content_of(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  return {work.tester, config.mask_test.rows, config.mask_test.projection_tables};
}

void load_on_chip(RtlUnit& unit, const cull::TableContent& content) {
  for (std::size_t table = 0; table < content.tables().size(); ++table)
    for (std::uint64_t row = 0; row < content.tables()[table].rows; ++row)
      unit.load_row(static_cast<int>(table), static_cast<std::uint32_t>(row),
                    {content.row(table, row), content.words(table)});
}

}  // namespace

std::uint64_t bytes_behind_image(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  const pipeline::UnitImage image(work.image, work.tester, false);
  const pipeline::MemoryMap map(config, image);
  return map.table_base - map.round_up(work.image.bytes.size());
}

void load_tables(RtlUnit& unit, std::span<std::uint8_t>, const pipeline::UnitConfig& config,
                 const pipeline::Work& work) {
  if (config.mask_test.design == cull::Design::None || config.mask_test.design == cull::Design::Comparators) {
    if (work.tester.compression_lut() == nullptr) return;
  }
  if (config.table_cache.bytes == 0) load_on_chip(unit, content_of(config, work));
}

}  // namespace ctu::cosim
