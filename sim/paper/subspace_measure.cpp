#include "sim/paper/subspace_measure.h"

#include <algorithm>

#include "model/base/parallel.h"
#include "model/cull/compress.h"
#include "model/cull/object_masks.h"
#include "model/cull/requirement_luts.h"
#include "sim/stopwatch.h"

namespace ctu::sim::paper {
namespace {

using cull::Design;
using cull::MaskOptions;
using cull::ObjectMasks;
using cull::Selection;

constexpr int kMostLevels = 5;
/// Work shorter than this is repeated.
constexpr double kLongEnoughSeconds = 0.5;

/// The median time of up to `repeats` runs of `work`, which says how long it took; fewer when it takes long.
template <class Work>
double median_of(int repeats, Work&& work) {
  std::vector<double> seconds;
  double sum = 0;
  for (int i = 0; i < std::max(repeats, 1) && (i == 0 || sum < kLongEnoughSeconds); ++i) {
    seconds.push_back(work());
    sum += seconds.back();
  }
  return median(seconds);
}

template <class Visit>
void for_each_mask(const accel::Bvh4& bvh, const ObjectMasks& masks, Visit&& visit) {
  for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node)
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      if (bvh.nodes[node].child[lane] != accel::kEmptyChild) visit(masks.mask(node, lane));
}

SearchResult measure_search(const accel::Bvh4& bvh, const ObjectMasks& masks, const cull::CompressionLut& lut,
                            int repeats) {
  SearchResult result;
  const ThreadStopwatch table_watch;
  const cull::RequirementLuts requirements(lut, kChunkBits);
  result.table_seconds = table_watch.seconds();
  std::vector<int> naive, ours;
  const auto time = [&](std::vector<int>& found, auto&& find) {
    return median_of(repeats, [&] {
      found.clear();
      found.reserve(4 * bvh.nodes.size());
      const ThreadStopwatch watch;
      for_each_mask(bvh, masks, [&](const std::uint64_t* mask) { found.push_back(find(mask)); });
      return watch.seconds();
    });
  };
  result.naive_seconds = time(naive, [&](const std::uint64_t* mask) { return lut.tightest(mask); });
  result.ours_seconds = time(ours, [&](const std::uint64_t* mask) { return requirements.find(mask); });
  result.masks = naive.size();
  for (std::size_t i = 0; i < naive.size(); ++i) result.differences += naive[i] != ours[i];
  return result;
}

/// Bits behind the R^3rd of each mask are zero everywhere.
void clear_beyond_the_cells(ObjectMasks& masks) {
  const int used = masks.resolution * masks.resolution * masks.resolution % 64;
  if (used == 0) return;
  const auto words = static_cast<std::size_t>(masks.words);
  for (std::size_t w = words - 1; w < masks.bits.size(); w += words) masks.bits[w] &= (std::uint64_t{1} << used) - 1;
}

/// Every set of object masks that one resolution needs, and what making them took.
struct MaskSets {
  MaskSets(const accel::Bvh4& bvh, int resolution, const MeasureOptions& options) {
    const int threads = options.survey.threads;
    for (int l = 1; l <= kMostLevels + 1; ++l) {
      const int levels = l <= kMostLevels ? l : cull::kUnlimitedLevels;
      const MaskOptions masks{.resolution = resolution, .ray_resolution = resolution, .levels = levels};
      by_level.emplace_back();
      const double seconds = median_of(options.repeats, [&] {
        const ProcessStopwatch watch;
        by_level.back() = cull::build_object_masks(bvh, masks, threads);
        return watch.seconds();
      });
      level_seconds.push_back(seconds);
    }
    const auto compress = [&](Selection selection) {
      const MaskOptions masks{.resolution = resolution,
                              .ray_resolution = resolution,
                              .entries = kCompressionEntries,
                              .selection = selection};
      return cull::compress(bvh, by_level.back(), masks, threads);
    };
    cull::CompressedMasks paper = compress(Selection::TopPerNode);
    search = measure_search(bvh, by_level.back(), paper.lut, options.repeats);
    compressed_paper = std::move(paper.masks);
    compressed_summed = compress(Selection::TopSummed).masks;
    cull::CompressedMasks ours = compress(Selection::Refined);
    compressed_ours = std::move(ours.masks);
    bit_table = std::make_unique<cull::MaskTester>(
        Design::BitTable,
        MaskOptions{.resolution = resolution, .ray_resolution = resolution, .entries = kCompressionEntries},
        std::make_shared<cull::CompressionLut>(std::move(ours.lut)));
    full = by_level.back();
    std::fill(full.bits.begin(), full.bits.end(), ~std::uint64_t{0});
    clear_beyond_the_cells(full);
  }

  const ObjectMasks& of(Column column) const {
    switch (column) {
      case Column::Unasked:
        return full;
      case Column::CompressedPaper:
        return compressed_paper;
      case Column::CompressedSummed:
        return compressed_summed;
      case Column::CompressedOurs:
      case Column::BitTable:
        return compressed_ours;
      default:
        return by_level.back();
    }
  }

  std::vector<ObjectMasks> by_level;  ///< L = 1 .. kMostLevels, then unlimited
  std::vector<double> level_seconds;
  ObjectMasks full, compressed_paper, compressed_summed, compressed_ours;
  std::unique_ptr<cull::MaskTester> bit_table;
  SearchResult search;
};

double percent_of(const ContenderSurvey& row, const ContenderSurvey& base) {
  const auto whole = base.counts.intersections();
  return whole == 0 ? 100 : 100 * static_cast<double>(row.counts.intersections()) / static_cast<double>(whole);
}

ColumnResult column_result(const ContenderSurvey& row, const ContenderSurvey& base) {
  ColumnResult result;
  result.percent = percent_of(row, base);
  result.seconds = median(row.seconds);
  std::vector<double> ratios;
  for (std::size_t r = 0; r < row.seconds.size(); ++r)
    if (base.seconds[r] > 0) ratios.push_back(row.seconds[r] / base.seconds[r]);
  if (!ratios.empty()) result.relative_seconds = median(ratios);
  return result;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[(values.size() - 1) / 2];
}

RayTables::RayTables(int resolution) : resolution_(resolution) {
  const auto make = [&](Column column, Design design, int ray_resolution) {
    const ThreadStopwatch watch;
    testers_[static_cast<std::size_t>(column)] = std::make_unique<cull::MaskTester>(
        design, MaskOptions{.resolution = resolution, .ray_resolution = ray_resolution});
    return watch.seconds();
  };
  make(Column::NoCulling, Design::None, resolution);
  make(Column::Ideal, Design::Ideal, resolution);
  lut_seconds_ = make(Column::Lut, Design::MaskLut, resolution);
  lut_double_seconds_ = make(Column::LutDouble, Design::MaskLut, 2 * resolution);
  make(Column::Comparators, Design::Comparators, resolution);
}

const cull::MaskTester& RayTables::tester(Column column) const {
  const auto& own = testers_[static_cast<std::size_t>(column)];
  return own ? *own : *testers_[static_cast<std::size_t>(Column::Lut)];
}

std::uint64_t RayTables::lut_bytes() const { return table_bytes(Column::Lut); }
std::uint64_t RayTables::lut_double_bytes() const { return table_bytes(Column::LutDouble); }

std::uint64_t RayTables::table_bytes(Column column) const {
  const cull::RayMaskTable& table = *tester(column).ray_mask_table();
  return 8 * static_cast<std::uint64_t>(table.rows()) * static_cast<std::uint64_t>(table.words());
}

ResolutionResult measure_subspace(const scene::Scene& scene, const accel::Bvh4& bvh, const RayTables& tables,
                                  const MeasureOptions& options, const std::function<void(std::uint64_t)>& progress) {
  const MaskSets masks(bvh, tables.resolution(), options);
  std::vector<Contender> contenders;
  for (std::size_t c = 0; c < kColumns; ++c) {
    const auto column = static_cast<Column>(c);
    const cull::MaskTester& tester = column == Column::BitTable ? *masks.bit_table : tables.tester(column);
    contenders.push_back({&tester, &masks.of(column), column != Column::CompressedSummed});
  }
  for (int l = 0; l < kMostLevels; ++l)
    contenders.push_back({&tables.tester(Column::Lut), &masks.by_level[static_cast<std::size_t>(l)], false});
  const RaySurvey survey = survey_rays(scene, bvh, contenders, options.survey, progress);

  ResolutionResult result;
  const ContenderSurvey& base = survey.contenders.front();
  result.resolution = tables.resolution();
  result.intersections_per_ray = base.counts.intersections_per_ray();
  result.rays = base.counts.rays;
  result.timed_rays = survey.timed_rays;
  result.search = masks.search;
  for (std::size_t c = 0; c < kColumns; ++c) result.columns[c] = column_result(survey.contenders[c], base);
  for (int l = 0; l < kMostLevels; ++l) {
    const auto at = static_cast<std::size_t>(l);
    result.levels.push_back({l + 1, percent_of(survey.contenders[kColumns + at], base), masks.level_seconds[at]});
  }
  result.levels.push_back({cull::kUnlimitedLevels, result.columns[static_cast<std::size_t>(Column::Lut)].percent,
                           masks.level_seconds.back()});
  for (const ContenderSurvey& row : survey.contenders) {
    result.lost_hits += row.lost_hits;
    result.near_misses += row.near_misses;
    result.ties += row.ties;
  }
  return result;
}

}  // namespace ctu::sim::paper
