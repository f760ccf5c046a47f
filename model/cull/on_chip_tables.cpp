#include "model/cull/on_chip_tables.h"

#include <algorithm>
#include <bit>

#include "model/base/error.h"
#include "model/cull/mask_mirror.h"

namespace ctu::cull {
namespace {

/// Bits of a number below `count`, at least 1.
int number_bits(std::uint32_t count) { return std::max(1, static_cast<int>(std::bit_width(count - 1))); }

int entries_of(const MaskTester& tester) {
  return tester.compression_lut() == nullptr ? 0 : tester.compression_lut()->entries();
}

}  // namespace

std::string_view to_string(TableRows rows) {
  switch (rows) {
    case TableRows::All:
      return "all";
    case TableRows::Folded:
      return "folded";
    case TableRows::Reachable:
      return "reachable";
  }
  return "unknown";
}

std::uint64_t bits_of(const std::vector<OnChipTable>& tables) {
  std::uint64_t bits = 0;
  for (const OnChipTable& table : tables) bits += table.bits();
  return bits;
}

OnChipTables::OnChipTables(const MaskTester& tester, TableRows rows, int projection_tables)
    : OnChipTables(tester.design(), tester.options(), entries_of(tester), tester.dedup_table(), rows,
                   projection_tables) {}

OnChipTables::OnChipTables(Design design, const MaskOptions& options, int entries, const DedupTable* dedup,
                           TableRows rows, int projection_tables)
    : design_(design), n_(options.ray_resolution) {
  if (projection_tables != 1 && projection_tables != 3)
    throw Error("projection tables", "are " + std::to_string(projection_tables), "choose 1 or 3");
  const int r = options.resolution, mask_bits = r * r * r;
  bool ands_masks = design != Design::None && design != Design::Ideal;
  switch (design) {
    case Design::MaskLut:
      number_rows(rows, true);
      add("ray masks", rows_by_key(), mask_bits);
      break;
    case Design::BitTable:
      ands_masks = false;
      number_rows(rows, false);
      add("bit table", rows_by_key(), entries);
      break;
    case Design::Dedup:
      ands_masks = entries == 0;
      number_rows(rows, ands_masks);
      add_dedup(*dedup, r, entries);
      break;
    case Design::Projection:
      number_rows(rows, true);
      add_projections(r * r, projection_tables);
      break;
    case Design::None:
    case Design::Ideal:
    case Design::Comparators:
      break;
  }
  if (!ands_masks || entries == 0) return;
  lut_table_ = static_cast<int>(tables_.size());
  add("compression-lut", static_cast<std::uint64_t>(entries), mask_bits);
}

void OnChipTables::number_rows(TableRows rows, bool rows_are_masks) {
  by_key_ = design_ != Design::Projection;
  if (rows == TableRows::All) return;
  const bool leave_out_inner = rows == TableRows::Reachable;
  numbering_ = rows_are_masks ? Numbering::Mirrored : Numbering::Reversed;
  if (!by_key_)
    projection_fold_ = MirrorFold<2>(n_, false);
  else if (rows_are_masks)
    mirror_fold_ = MirrorFold<3>(n_, leave_out_inner);
  else
    reverse_fold_ = ReverseFold(n_, leave_out_inner);
}

std::uint32_t OnChipTables::rows_by_key() const {
  if (numbering_ == Numbering::Mirrored) return mirror_fold_.rows();
  return numbering_ == Numbering::ByKey ? key_count(n_) : reverse_fold_.rows();
}

void OnChipTables::add_projections(int row_bits, int projection_tables) {
  const auto n = static_cast<std::uint32_t>(n_);
  const std::uint32_t rows = numbering_ == Numbering::ByKey ? n * n * n * n : projection_fold_.rows();
  projection_step_ = projection_tables == 3 ? 1 : 0;
  if (projection_tables == 1) return add("projections", rows, row_bits);
  for (const char* axes : {"xy", "yz", "xz"}) add(std::string("projections ") + axes, rows, row_bits);
}

std::uint32_t OnChipTables::number_canonical_masks(const DedupTable& dedup, int resolution) {
  id_of_row_.assign(rows_by_key(), kNoRow);
  std::vector<std::uint32_t> new_number(dedup.distinct(), kNoRow);
  MirrorNumbering mirror_images(resolution);
  std::uint32_t distinct = 0;
  for (std::uint32_t number = 0; number < key_count(n_); ++number) {
    const CellKey key = numbered_key(number, n_);
    const std::uint32_t row = row_of(key);
    if (row == kNoRow || id_of_row_[row] != kNoRow) continue;
    const std::uint32_t old = dedup.id(number);
    if (new_number[old] == kNoRow) {
      new_number[old] = numbering_ == Numbering::Mirrored ? mirror_images.number_of(dedup.row(old)).number : distinct;
      ++distinct;
    }
    id_of_row_[row] = new_number[old];
  }
  return numbering_ == Numbering::Mirrored ? mirror_images.count() : distinct;
}

void OnChipTables::add_dedup(const DedupTable& dedup, int resolution, int entries) {
  std::uint32_t distinct = dedup.distinct();
  if (numbering_ == Numbering::ByKey)
    id_of_row_ = dedup.ids();
  else
    distinct = number_canonical_masks(dedup, resolution);
  const int mirror_bits = numbering_ == Numbering::Mirrored ? 3 : 0;
  add("ids", id_of_row_.size(), number_bits(distinct) + mirror_bits);
  if (entries == 0)
    add("distinct masks", distinct, resolution * resolution * resolution);
  else
    add("bit rows", distinct, entries);
}

UsedRows::UsedRows(const OnChipTables& tables) : tables_(tables) {
  for (const OnChipTable& table : tables.tables()) used_.emplace_back(table.rows);
}

void UsedRows::add(CellKey key, std::uint32_t mask_index) {
  TableRead reads[kMaxReadsOfLane];
  const int count = tables_.reads(key, mask_index, reads);
  for (int i = 0; i < count; ++i) used_[reads[i].table][reads[i].row] = true;
}

std::vector<OnChipTable> UsedRows::tables() const {
  std::vector<OnChipTable> used = tables_.tables();
  for (std::size_t t = 0; t < used.size(); ++t)
    used[t].rows = static_cast<std::uint64_t>(std::count(used_[t].begin(), used_[t].end(), true));
  return used;
}

}  // namespace ctu::cull
