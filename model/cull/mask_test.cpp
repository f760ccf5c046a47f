#include "model/cull/mask_test.h"

#include <cassert>
#include <optional>
#include <string>

#include "model/base/error.h"
#include "model/cull/bit_rows.h"
#include "model/cull/cell_bits.h"

namespace ctu::cull {

struct MaskTester::Tables {
  Design design;
  MaskOptions options;
  std::shared_ptr<const CompressionLut> lut;
  std::optional<RayMaskTable> ray_masks;
  std::optional<ProjectionTable> projections;
  std::optional<BitTable> bits;
  std::optional<DedupTable> dedup;
};

namespace {

template <int R>
bool share_a_cell(const std::uint64_t* ray_mask, const std::uint64_t* object_mask) {
  std::uint64_t both = 0;
  for (int w = 0; w < kWords<R>; ++w) both |= ray_mask[w] & object_mask[w];
  return both != 0;
}

template <int R>
constexpr MaskWords<R> make_full_mask() {
  MaskWords<R> words{};
  for (int cell = 0; cell < R * R * R; ++cell)
    words[static_cast<std::size_t>(cell / 64)] |= std::uint64_t{1} << (cell % 64);
  return words;
}
template <int R>
inline constexpr MaskWords<R> kFullMask = make_full_mask<R>();

template <int R>
unsigned full_lanes_of(const std::uint64_t* object_masks) {
  unsigned full = 0;
  for (int lane = 0; lane < intersect::kLanes; ++lane, object_masks += kWords<R>) {
    std::uint64_t missing = 0;
    for (int w = 0; w < kWords<R>; ++w) missing |= object_masks[w] ^ kFullMask<R>[w];
    full |= (missing == 0 ? 1u : 0u) << lane;
  }
  return full;
}

/// What full_lanes_of says of the masks that the indices stand for: the last entry is the full one.
unsigned full_indices(const std::uint16_t* index, int entries) {
  unsigned full = 0;
  for (int lane = 0; lane < intersect::kLanes; ++lane) full |= (index[lane] == entries - 1 ? 1u : 0u) << lane;
  return full;
}

template <class Body>
void for_each_lane(unsigned lanes, Body&& body) {
  for (int lane = 0; lane < intersect::kLanes; ++lane)
    if ((lanes >> lane & 1) != 0) body(lane);
}

/// The designs that find the ray's cells from the times of the lane: `mask_of(lane, words)`.
template <int R, class MaskOf>
MaskTestResult test_by_times(unsigned lanes, const std::uint64_t* object_masks, MaskOf&& mask_of) {
  const unsigned full = full_lanes_of<R>(object_masks);
  MaskTestResult result;
  result.pass = static_cast<std::uint8_t>(lanes & full);
  for_each_lane(lanes & ~full, [&](int lane) {
    MaskWords<R> ray_mask;
    mask_of(lane, ray_mask.data());
    if (share_a_cell<R>(ray_mask.data(), object_masks + lane * kWords<R>))
      result.pass |= static_cast<std::uint8_t>(1u << lane);
  });
  return result;
}

/// The designs that read tables: `passes(key, lane)` is only asked for keys that are certain.
template <class Passes>
MaskTestResult test_by_key(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                           const intersect::Box4& boxes, int ray_resolution, unsigned full, Passes&& passes) {
  MaskTestResult result;
  result.pass = static_cast<std::uint8_t>(times.hit & full);
  for_each_lane(times.hit & ~full, [&](int lane) {
    const CellKey key = cell_locate(ray, times, boxes, lane, ray_resolution);
    const auto bit = static_cast<std::uint8_t>(1u << lane);
    result.key[lane] = key.packed;
    if (key.uncertain()) {
      result.uncertain |= bit;
      result.pass |= bit;
    } else if (passes(key, lane)) {
      result.pass |= bit;
    }
  });
  return result;
}

/// ... with rows that are masks: `mask_of(key)`.
template <int R, class MaskOf>
MaskTestResult test_by_mask(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                            const intersect::Box4& boxes, int ray_resolution, const std::uint64_t* object_masks,
                            MaskOf&& mask_of) {
  return test_by_key(ray, times, boxes, ray_resolution, full_lanes_of<R>(object_masks), [&](CellKey key, int lane) {
    return share_a_cell<R>(mask_of(key), object_masks + lane * kWords<R>);
  });
}

/// ... with rows of a bit for every entry: `row_of(key)`.
template <class RowOf>
MaskTestResult test_by_bit(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                           const intersect::Box4& boxes, int ray_resolution, const std::uint16_t* index, int entries,
                           RowOf&& row_of) {
  assert(index != nullptr);
  return test_by_key(ray, times, boxes, ray_resolution, full_indices(index, entries),
                     [&](CellKey key, int lane) { return bit_of_row(row_of(key), index[lane]); });
}

void check_compression(Design design, const MaskOptions& options, const CompressionLut* lut) {
  if (lut == nullptr && design == Design::BitTable)
    throw Error("mask-test design bit-table", "the object masks are not compressed, and its columns are LUT entries",
                "record the scene with --compress N, or choose `dedup`, which works without");
  if (lut != nullptr && lut->resolution() != options.resolution)
    throw Error("compression LUT", "holds masks of R = " + std::to_string(lut->resolution()),
                "compress masks of R = " + std::to_string(options.resolution));
}

}  // namespace

MaskTester::MaskTester(Design design, const MaskOptions& options, std::shared_ptr<const CompressionLut> lut)
    : tables_(std::make_unique<Tables>()) {
  validate(options);
  check_compression(design, options, lut.get());
  tables_->design = design;
  tables_->options = options;
  tables_->lut = std::move(lut);
  if (design == Design::MaskLut) tables_->ray_masks.emplace(options.resolution, options.ray_resolution);
  if (design == Design::Projection) tables_->projections.emplace(options.resolution, options.ray_resolution);
  if (design == Design::BitTable) tables_->bits.emplace(*tables_->lut, options.ray_resolution);
  if (design == Design::Dedup) tables_->dedup.emplace(options.resolution, options.ray_resolution, tables_->lut.get());
}

MaskTester::~MaskTester() = default;
MaskTester::MaskTester(MaskTester&&) noexcept = default;
MaskTester& MaskTester::operator=(MaskTester&&) noexcept = default;

Design MaskTester::design() const { return tables_->design; }
const MaskOptions& MaskTester::options() const { return tables_->options; }
const RayMaskTable* MaskTester::ray_mask_table() const { return tables_->ray_masks ? &*tables_->ray_masks : nullptr; }
const ProjectionTable* MaskTester::projection_table() const {
  return tables_->projections ? &*tables_->projections : nullptr;
}

const CompressionLut* MaskTester::compression_lut() const { return tables_->lut.get(); }

const BitTable* MaskTester::bit_table() const { return tables_->bits ? &*tables_->bits : nullptr; }
const DedupTable* MaskTester::dedup_table() const { return tables_->dedup ? &*tables_->dedup : nullptr; }

unsigned full_lanes(const std::uint64_t* object_masks, int resolution) {
  return with_resolution(resolution, [&](auto r) { return full_lanes_of<r()>(object_masks); });
}

MaskTestResult MaskTester::test(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                                const intersect::Box4& boxes, const NodeMasks& masks) const {
  const std::uint64_t* object_masks = masks.bits;
  const Tables& tables = *tables_;
  const int ray_resolution = tables.options.ray_resolution;
  return with_resolution(tables.options.resolution, [&](auto r) {
    constexpr int R = r();
    switch (tables.design) {
      case Design::Ideal:
        return test_by_times<R>(times.hit, object_masks,
                                [&](int lane, std::uint64_t* words) { ideal_mask(ray, times, boxes, lane, R, words); });
      case Design::Comparators:
        return test_by_times<R>(times.hit, object_masks, [&](int lane, std::uint64_t* words) {
          comparator_mask(ray, times, boxes, lane, R, words);
        });
      case Design::MaskLut:
        return test_by_mask<R>(ray, times, boxes, ray_resolution, object_masks,
                               [&](CellKey key) { return tables.ray_masks->row(tables.ray_masks->row_index(key)); });
      case Design::Projection: {
        MaskWords<R> words;
        return test_by_mask<R>(ray, times, boxes, ray_resolution, object_masks, [&](CellKey key) {
          tables.projections->ray_mask(key, words.data());
          return words.data();
        });
      }
      case Design::BitTable:
        return test_by_bit(ray, times, boxes, ray_resolution, masks.index, tables.lut->entries(),
                           [&](CellKey key) { return tables.bits->row(key_number(key, ray_resolution)); });
      case Design::Dedup: {
        const DedupTable& dedup = *tables.dedup;
        const auto row_of = [&](CellKey key) { return dedup.row(dedup.id(key_number(key, ray_resolution))); };
        if (tables.lut == nullptr) return test_by_mask<R>(ray, times, boxes, ray_resolution, object_masks, row_of);
        return test_by_bit(ray, times, boxes, ray_resolution, masks.index, tables.lut->entries(), row_of);
      }
      case Design::None:
        break;
    }
    MaskTestResult all;
    all.pass = times.hit;
    return all;
  });
}

}  // namespace ctu::cull
