#include "model/pipeline/table_lines.h"

namespace ctu::pipeline {
namespace {

/// Whether a lane reads one bit of the memory's rows.
bool reads_one_bit(const UnitConfig& config, std::size_t table, bool compressed) {
  if (config.mask_test.design == cull::Design::BitTable) return true;
  return compressed && is_second_read(config.mask_test.design, static_cast<int>(table));
}

}  // namespace

TableLayout::TableLayout(const UnitConfig& config, const cull::OnChipTables& tables, const MemoryMap& map,
                         bool compressed)
    : end_(map.table_base) {
  for (std::size_t i = 0; i < tables.tables().size(); ++i) {
    const cull::OnChipTable& table = tables.tables()[i];
    Table placed;
    placed.base = end_;
    placed.row_bytes = (table.row_bits + 7) / 8;
    placed.stride_shift = std::countr_zero(std::bit_ceil(placed.row_bytes));
    placed.by_bit = reads_one_bit(config, i, compressed);
    tables_.push_back(placed);
    end_ = map.round_up(placed.base + (table.rows << placed.stride_shift));
  }
}

}  // namespace ctu::pipeline
