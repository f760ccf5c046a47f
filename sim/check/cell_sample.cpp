#include "sim/check/cell_sample.h"

#include "model/cull/ideal.h"
#include "tests/oracle/exact_cells.h"

namespace ctu::sim::check {
namespace {

constexpr int kMostWords = cull::words_per_mask(cull::kMaxResolution);

/// What a design marks in one lane.
struct Marked {
  bool known = false;  ///< false: the key is uncertain
  std::uint64_t words[kMostWords] = {};
  bool has(std::size_t cell) const { return (words[cell / 64] >> (cell % 64) & 1) != 0; }
};

Marked marked_cells(const CheckScene& scene, const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                    const intersect::Box4& boxes, int lane, TesterCache& testers) {
  const cull::MaskOptions& masks = scene.setup.masks;
  Marked marked;
  marked.known = true;
  if (scene.setup.design == cull::Design::Ideal) {
    cull::ideal_mask(ray, times, boxes, lane, masks.resolution, marked.words);
  } else if (scene.setup.design == cull::Design::Comparators) {
    cull::comparator_mask(ray, times, boxes, lane, masks.resolution, marked.words);
  } else {
    const cull::CellKey key = cull::cell_locate(ray, times, boxes, lane, masks.ray_resolution);
    marked.known = !key.uncertain();
    if (marked.known)
      testers.get(cull::Design::Projection, masks.resolution, masks.ray_resolution)
          ->projection_table()
          ->ray_mask(key, marked.words);
  }
  return marked;
}

}  // namespace

void sample_cells(const CheckScene& scene, const intersect::Ray& ray, std::uint32_t node, TesterCache& testers,
                  Tally& tally) {
  if (scene.setup.design == cull::Design::None) return;
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  const intersect::Box4& boxes = scene.bvh.nodes[node].boxes;
  const intersect::SlabTimes times = intersect::slab_test(prepared, boxes, ray.tmax);
  const int resolution = scene.setup.masks.resolution;
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    if ((times.hit >> lane & 1) == 0) continue;
    const Marked marked = marked_cells(scene, prepared, times, boxes, lane, testers);
    if (!marked.known) continue;
    const Vec3 lo{boxes.lo[0][lane], boxes.lo[1][lane], boxes.lo[2][lane]},
        hi{boxes.hi[0][lane], boxes.hi[1][lane], boxes.hi[2][lane]};
    const auto closed = oracle::exact_ray_cells(ray, lo, hi, resolution, ray.tmin, ray.tmax, oracle::Cells::Closed);
    const auto half_open =
        oracle::exact_ray_cells(ray, lo, hi, resolution, ray.tmin, ray.tmax, oracle::Cells::HalfOpen);
    ++tally.sampled_lanes;
    for (std::size_t cell = 0; cell < closed.size(); ++cell) {
      tally.cells_marked += marked.has(cell);
      tally.cells_exact += closed[cell];
      tally.cells_over += marked.has(cell) && closed[cell] == 0;
      tally.cells_lost += !marked.has(cell) && half_open[cell] != 0;
    }
  }
}

}  // namespace ctu::sim::check
