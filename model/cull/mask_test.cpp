#include "model/cull/mask_test.h"

#include <optional>

#include "model/cull/cell_bits.h"

namespace ctu::cull {

struct MaskTester::Tables {
  Design design;
  MaskOptions options;
  std::shared_ptr<const CompressionLut> lut;
  std::optional<RayMaskTable> ray_masks;
  std::optional<ProjectionTable> projections;
};

namespace {

template <int R>
bool share_a_cell(const std::uint64_t* ray_mask, const std::uint64_t* object_mask) {
  std::uint64_t both = 0;
  for (int w = 0; w < kWords<R>; ++w) both |= ray_mask[w] & object_mask[w];
  return both != 0;
}

template <class Body>
void for_each_lane(unsigned lanes, Body&& body) {
  for (int lane = 0; lane < intersect::kLanes; ++lane)
    if ((lanes >> lane & 1) != 0) body(lane);
}

/// The designs that find the ray's cells from the times of the lane: `mask_of(lane, words)`.
template <int R, class MaskOf>
MaskTestResult test_by_times(unsigned lanes, const std::uint64_t* object_masks, MaskOf&& mask_of) {
  MaskTestResult result;
  for_each_lane(lanes, [&](int lane) {
    MaskWords<R> ray_mask;
    mask_of(lane, ray_mask.data());
    if (share_a_cell<R>(ray_mask.data(), object_masks + lane * kWords<R>))
      result.pass |= static_cast<std::uint8_t>(1u << lane);
  });
  return result;
}

/// The designs that read tables: `mask_of(key)` is only asked for keys that are certain.
template <int R, class MaskOf>
MaskTestResult test_by_key(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                           const intersect::Box4& boxes, int ray_resolution, const std::uint64_t* object_masks,
                           MaskOf&& mask_of) {
  MaskTestResult result;
  for_each_lane(times.hit, [&](int lane) {
    const CellKey key = cell_locate(ray, times, boxes, lane, ray_resolution);
    const auto bit = static_cast<std::uint8_t>(1u << lane);
    result.key[lane] = key.packed;
    if (key.uncertain()) {
      result.uncertain |= bit;
      result.pass |= bit;
    } else if (share_a_cell<R>(mask_of(key), object_masks + lane * kWords<R>)) {
      result.pass |= bit;
    }
  });
  return result;
}

}  // namespace

MaskTester::MaskTester(Design design, const MaskOptions& options, std::shared_ptr<const CompressionLut> lut)
    : tables_(std::make_unique<Tables>()) {
  validate(options);
  tables_->design = design;
  tables_->options = options;
  tables_->lut = std::move(lut);
  if (design == Design::MaskLut) tables_->ray_masks.emplace(options.resolution, options.ray_resolution);
  if (design == Design::Projection) tables_->projections.emplace(options.resolution, options.ray_resolution);
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
        return test_by_key<R>(ray, times, boxes, ray_resolution, object_masks,
                              [&](CellKey key) { return tables.ray_masks->row(tables.ray_masks->row_index(key)); });
      case Design::BitTable:
      case Design::Dedup:
      case Design::Projection: {
        MaskWords<R> words;
        return test_by_key<R>(ray, times, boxes, ray_resolution, object_masks, [&](CellKey key) {
          tables.projections->ray_mask(key, words.data());
          return words.data();
        });
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
