// One scene through everything the subspace culling paper evaluates: Table 1 (intersections), Table 2 (time of the
// untimed reference), Table 3 (search in a compression LUT) and Fig. 8 (L), at one mask resolution.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/cull/options.h"
#include "model/scene/scene.h"
#include "sim/ray_survey.h"

namespace ctu::sim::paper {

/// Entries of the compression LUT and bits of a chunk of the requirement LUTs (section 4.4).
inline constexpr int kCompressionEntries = 256;
inline constexpr int kChunkBits = 8;

/// What Tables 1 and 2 compare, and more. The compressed columns' rays have masks of R_ray = R.
enum class Column : std::uint8_t {
  NoCulling,
  Unasked,  ///< every object mask full: the box test that culling needs, and no question behind it
  Ideal,
  Lut,               ///< ray mask LUT, R_ray = R
  LutDouble,         ///< R_ray = 2R
  CompressedPaper,   ///< Lut over 256 entries: the masks of the most important children (section 3.2.2)
  CompressedSummed,  ///< ... with importance summed over equal masks
  CompressedOurs,    ///< ... our selection
  BitTable,          ///< CompressedOurs' entries, asked by a bit table (section 3.2.2)
  Comparators,       ///< our design without tables
};
inline constexpr std::size_t kColumns = 10;

/// The ray mask tables at one R: made once, used for every scene.
class RayTables {
 public:
  explicit RayTables(int resolution);
  int resolution() const { return resolution_; }
  /// For the compressed columns, too: what is compressed are the object masks. BitTable's depends on the scene.
  const cull::MaskTester& tester(Column column) const;
  double lut_seconds() const { return lut_seconds_; }                ///< to make the table of R_ray = R
  double lut_double_seconds() const { return lut_double_seconds_; }  ///< ... and of 2R
  std::uint64_t lut_bytes() const;
  std::uint64_t lut_double_bytes() const;

 private:
  std::uint64_t table_bytes(Column column) const;

  int resolution_;
  double lut_seconds_ = 0, lut_double_seconds_ = 0;
  std::array<std::unique_ptr<cull::MaskTester>, kColumns> testers_;
};

struct ColumnResult {
  double percent = 100;         ///< intersections relative to no culling
  double seconds = 0;           ///< median over repeats, of the timed rays
  double relative_seconds = 1;  ///< median over repeats of the ratio to no culling in the same repeat
};

/// Fig. 8: object masks from L levels below.
struct LevelResult {
  int levels = cull::kUnlimitedLevels;
  double percent = 100;  ///< intersections relative to no culling, R_ray = R
  double seconds = 0;    ///< processor time to make the masks
};

/// Table 3: all masks of the tree, looked for in the LUT of CompressedPaper, one thread.
struct SearchResult {
  std::uint64_t masks = 0;
  double naive_seconds = 0, ours_seconds = 0;
  double table_seconds = 0;       ///< to make the requirement LUTs
  std::uint64_t differences = 0;  ///< masks for which the two found different entries: a defect
};

struct ResolutionResult {
  int resolution = 0;
  double intersections_per_ray = 0;  ///< without culling
  std::uint64_t rays = 0, timed_rays = 0;
  std::array<ColumnResult, kColumns> columns;
  std::vector<LevelResult> levels;  ///< L = 1 .. 5, then unlimited
  SearchResult search;
  std::uint64_t lost_hits = 0, near_misses = 0, ties = 0;  ///< of all columns and levels
};

/// What is measured beside the rays; `rays`, `threads` and the timing are those of SurveyOptions.
struct MeasureOptions {
  SurveyOptions survey;
  int repeats = 3;  ///< of mask making and of the search
};

ResolutionResult measure_subspace(const scene::Scene& scene, const accel::Bvh4& bvh, const RayTables& tables,
                                  const MeasureOptions& options,
                                  const std::function<void(std::uint64_t paths_done)>& progress);

/// The middle one; the lower of two. 0 for none.
double median(std::vector<double> values);

}  // namespace ctu::sim::paper
