#include "model/cull/on_chip_tables.h"

#include <algorithm>
#include <bit>

#include "model/base/error.h"

namespace ctu::cull {
namespace {

/// Bits of a number below `count`, at least 1.
int number_bits(std::uint32_t count) { return std::max(1, static_cast<int>(std::bit_width(count - 1))); }

}  // namespace

OnChipTables::OnChipTables(const MaskTester& tester, TableRows rows, int projection_tables)
    : design_(tester.design()), rows_(rows), ray_resolution_(tester.options().ray_resolution) {
  if (projection_tables != 1 && projection_tables != 3)
    throw Error("projection tables", "are " + std::to_string(projection_tables), "choose 1 or 3");
  const int r = tester.options().resolution, mask_bits = r * r * r;
  const std::uint32_t keys = key_count(ray_resolution_);
  const CompressionLut* lut = tester.compression_lut();
  bool reads_lut = lut != nullptr;
  switch (design_) {
    case Design::MaskLut:
      add("ray masks", keys, mask_bits);
      break;
    case Design::BitTable:
      add("bit table", keys, lut->entries());
      reads_lut = false;
      break;
    case Design::Dedup: {
      const DedupTable& dedup = *tester.dedup_table();
      id_of_row_ = dedup.ids();
      add("ids", keys, number_bits(dedup.distinct()));
      if (lut == nullptr)
        add("distinct masks", dedup.distinct(), mask_bits);
      else
        add("bit rows", dedup.distinct(), lut->entries());
      reads_lut = false;
      break;
    }
    case Design::Projection:
      projection_step_ = projection_tables == 3 ? 1 : 0;
      for (const char* name : {"xy", "yz", "xz"}) {
        add(projection_tables == 3 ? std::string("projections ") + name : "projections",
            tester.projection_table()->rows(), r * r);
        if (projection_tables == 1) break;
      }
      break;
    case Design::Comparators:
      break;
    case Design::None:
    case Design::Ideal:
      reads_lut = false;
      break;
  }
  if (!reads_lut) return;
  lut_table_ = static_cast<int>(tables_.size());
  add("compression-lut", static_cast<std::uint64_t>(lut->entries()), mask_bits);
}

void OnChipTables::add(std::string name, std::uint64_t rows, int row_bits) {
  tables_.push_back({std::move(name), rows, static_cast<std::uint32_t>(row_bits)});
}

std::uint64_t OnChipTables::bits() const {
  std::uint64_t bits = 0;
  for (const OnChipTable& table : tables_) bits += table.bits();
  return bits;
}

}  // namespace ctu::cull
