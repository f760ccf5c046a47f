#include "model/pipeline/table_banks.h"

#include <algorithm>

namespace ctu::pipeline {

using cull::Design;

TableBanks::TableBanks(const UnitConfig& config, const cull::MaskTester& tester)
    : design_(config.mask_test.design),
      tester_(tester),
      bank_mask_(static_cast<std::uint32_t>(config.mask_test.banks - 1)),
      ports_(config.mask_test.ports) {
  const auto r = static_cast<std::uint64_t>(tester.options().resolution);
  if (design_ == Design::MaskLut) {
    tables_ = 1;
    rows_ = tester.ray_mask_table()->rows();
    row_bits_ = r * r * r;
  } else if (design_ == Design::Projection) {
    tables_ = config.mask_test.projection_tables;
    rows_ = tester.projection_table()->rows();
    row_bits_ = r * r;
  }
  used_.resize(static_cast<std::size_t>(tables_) * rows_);
}

int TableBanks::read_tables(const LaneKeys& keys) {
  for (int table = 0; table < tables_; ++table) pending_[table].count = 0;
  for (int i = 0; i < keys.count; ++i) {
    const cull::CellKey key{keys.key[i]};
    if (key.uncertain()) continue;
    if (design_ == Design::MaskLut) {
      add(0, tester_.ray_mask_table()->row_index(key));
    } else {
      const cull::ProjectionTable& table = *tester_.projection_table();
      const bool apart = tables_ == kMaxTables;
      add(0, table.row_index(key, cull::AxisPair::XY));
      add(apart ? 1 : 0, table.row_index(key, cull::AxisPair::YZ));
      add(apart ? 2 : 0, table.row_index(key, cull::AxisPair::XZ));
    }
  }
  int most = 1;
  for (int table = 0; table < tables_; ++table) most = std::max(most, most_in_a_bank(pending_[table]));
  return ports_ == 1 ? most : (most + ports_ - 1) / ports_;
}

void TableBanks::add(int table, std::uint32_t row) {
  Reads& reads = pending_[table];
  for (int i = 0; i < reads.count; ++i)
    if (reads.row[i] == row) {
      ++shared_;
      return;
    }
  reads.row[reads.count++] = row;
  ++reads_;
  auto used = used_[static_cast<std::size_t>(table) * rows_ + row];
  if (used) return;
  used = true;
  ++rows_used_;
}

int TableBanks::most_in_a_bank(const Reads& reads) const {
  int most = 1;
  for (int i = 1; i < reads.count; ++i) {
    int in_bank = 1;
    for (int j = 0; j < i; ++j) in_bank += ((reads.row[j] ^ reads.row[i]) & bank_mask_) == 0;
    most = std::max(most, in_bank);
  }
  return most;
}

}  // namespace ctu::pipeline
