// What table_fetch brings for the lanes of a node, as rtl/table_fetch.sv keeps it and rtl/mask_test.sv reads it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/accel/image.h"
#include "model/cull/table_content.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {

/// Writes the lowest `bits` of 64-bit words.
inline void put(BitWriter& writer, const std::uint64_t* words, std::uint32_t bits) {
  for (std::uint32_t bit = 0; bit < bits; bit += 64)
    writer.put(words[bit / 64], static_cast<int>(std::min(64u, bits - bit)));
}

/// A lane's object mask or index; 0 of nodes that carry none.
inline std::vector<std::uint64_t> object_mask(const accel::Image& image, const pipeline::ExecSource::Registers& r,
                                              int lane) {
  std::vector<std::uint64_t> mask(pipeline::ExecSource::kMaxWords);
  if (!accel::is_leaf(r.step.ref) && r.step.ref < image.masked_nodes())
    accel::read_mask(image, r.step.ref, lane, mask.data());
  return mask;
}

class FetchedRows {
 public:
  FetchedRows(const test::World& world, const pipeline::UnitConfig& config)
      : world_(world),
        rows_(config.mask_test.rows),
        tables_(world.tester(), rows_, config.mask_test.projection_tables),
        content_(world.tester(), rows_, config.mask_test.projection_tables),
        keyed_(config.mask_test.design != cull::Design::Comparators) {}

  const cull::TableContent& content() const { return content_; }

  /// Whether the lane reads.
  bool reads(const pipeline::ExecSource::Registers& r, int lane) const {
    return !keyed_ || !cull::CellKey{r.key[lane]}.uncertain();
  }
  /// Writes all that the lane reads but the number in an id; anything where it does not read.
  void put_lane(BitWriter& writer, const pipeline::ExecSource::Registers& r, int lane) const {
    const bool compressed = world_.tester().compression_lut() != nullptr;
    const bool mirrors = rows_ != cull::TableRows::All && !compressed;
    const auto index = compressed ? static_cast<std::uint32_t>(object_mask(world_.image(), r, lane)[0]) : 0;
    cull::TableRead reads[cull::kMaxReadsOfLane];
    int count = this->reads(r, lane) ? tables_.reads(cull::CellKey{keyed_ ? r.key[lane] : 0}, index, reads) : -1;
    if (count < 0) count = tables_.reads({}, index, reads);
    for (const cull::TableRead& read : std::span(reads, static_cast<std::size_t>(count))) {
      const std::uint64_t* const row = content_.row(read.table, read.row);
      const cull::OnChipTable& table = content_.tables()[read.table];
      if (table.name == "ids")
        writer.put(*row, mirrors ? 3 : 0);
      else if (table.name == "bit rows" || table.name == "bit table")
        writer.put(row[index / 64] >> (index % 64 / 8 * 8), 8);
      else
        put(writer, row, table.row_bits);
    }
  }

 private:
  const test::World& world_;
  cull::TableRows rows_;
  cull::OnChipTables tables_;
  cull::TableContent content_;
  bool keyed_;
};

}  // namespace ctu::rtl
