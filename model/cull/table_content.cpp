#include "model/cull/table_content.h"

#include <algorithm>

#include "model/cull/key_fold.h"
#include "model/cull/mask_mirror.h"

namespace ctu::cull {
namespace {

/// Bits of an id that say how the mask is mirrored.
constexpr std::uint32_t kMirrorBits = 3;

template <int Axes>
bool is_canonical(const MirrorFold<Axes>& fold, CellKey key, int n) {
  typename MirrorFold<Axes>::Pairs pairs;
  for (int axis = 0; axis < Axes; ++axis)
    pairs.of[axis] = static_cast<std::uint32_t>(key.begin(axis) + n * key.end(axis));
  return fold.fold(pairs).canonical.packed == key.packed;
}

bool rows_are_masks(const MaskTester& tester) {
  return tester.design() != Design::BitTable &&
         (tester.design() != Design::Dedup || tester.compression_lut() == nullptr);
}

}  // namespace

TableContent::TableContent(const MaskTester& tester, TableRows rows, int projection_tables)
    : tables_(tester, rows, projection_tables) {
  for (const OnChipTable& table : tables()) bits_.emplace_back(table.rows * ((table.row_bits + 63) / 64));
  const bool mirrors = rows != TableRows::All && rows_are_masks(tester);
  if (tester.design() == Design::Projection)
    fill_projections(tester, mirrors, static_cast<std::size_t>(projection_tables));
  else if (reads_tables(tester.design()))
    fill_by_key(tester, mirrors);
  const CompressionLut* const lut = tester.compression_lut();
  if (lut == nullptr || !rows_are_masks(tester) || tables().empty()) return;
  for (int entry = 0; entry < lut->entries(); ++entry)
    set(tables().size() - 1, static_cast<std::uint64_t>(entry), lut->entry(entry));
}

void TableContent::set(std::size_t table, std::uint64_t row, const std::uint64_t* words) {
  const std::size_t count = this->words(table);
  std::copy_n(words, count, bits_[table].begin() + static_cast<std::ptrdiff_t>(row * count));
}

void TableContent::fill_by_key(const MaskTester& tester, bool mirrors) {
  const int n = tester.options().ray_resolution;
  const MirrorFold<3> fold = mirrors ? MirrorFold<3>(n, false) : MirrorFold<3>();
  for (std::uint32_t number = 0; number < key_count(n); ++number) {
    const CellKey key = numbered_key(number, n);
    TableRead reads[kMaxReadsOfLane];
    if (tables_.reads(key, 0, reads) < 0 || (mirrors && !is_canonical(fold, key, n))) continue;
    if (tester.design() == Design::MaskLut)
      set(0, reads[0].row, tester.ray_mask_table()->row(number));
    else if (tester.design() == Design::BitTable)
      set(0, reads[0].row, tester.bit_table()->row(number));
    else
      fill_ids(*tester.dedup_table(), number, mirrors ? tester.options().resolution : 0, reads[0], reads[1]);
  }
}

void TableContent::fill_ids(const DedupTable& dedup, std::uint32_t number, int mirrored_resolution, const TableRead& id,
                            const TableRead& row) {
  const std::uint64_t* const mask = dedup.row(dedup.id(number));
  std::uint64_t content = row.row;
  if (mirrored_resolution == 0) {
    set(1, row.row, mask);
  } else {
    const std::uint64_t axes = MirrorNumbering(mirrored_resolution).number_of(mask).axes;
    content = content << kMirrorBits | axes;
    set(1, row.row, mirrored_mask(mask, mirrored_resolution, static_cast<unsigned>(axes)).data());
  }
  set(0, id.row, &content);
}

void TableContent::fill_projections(const MaskTester& tester, bool mirrors, std::size_t count) {
  const int n = tester.options().ray_resolution;
  const MirrorFold<2> fold = mirrors ? MirrorFold<2>(n, false) : MirrorFold<2>();
  for (int pair = 0; pair < n * n * n * n; ++pair) {
    const int begin_x = pair % n, begin_y = pair / n % n, end_x = pair / (n * n) % n, end_y = pair / (n * n * n);
    CellKey key;
    key.set(0, begin_x, end_x);
    key.set(1, begin_y, end_y);
    if (mirrors && !is_canonical(fold, key, n)) continue;
    TableRead reads[kMaxReadsOfLane];
    tables_.reads(key, 0, reads);
    const std::uint64_t row = tester.projection_table()->row(tester.projection_table()->row_index(key, AxisPair::XY));
    for (std::size_t table = 0; table < count; ++table) set(table, reads[0].row, &row);
  }
}

}  // namespace ctu::cull
