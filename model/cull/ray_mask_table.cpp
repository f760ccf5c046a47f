// The sweep, in exact integers. Take N = lcm(R, R_ray) units along an axis: a mask cell is N/R units wide, a ray cell
// N/R_ray. While the sweep's time goes from 0 to 1, the moving ray cell reaches from b + s(e-b) to one width more, and
// overlaps a run of mask cells; the run changes when one of its two ends crosses a border. Between two such
// moments of any axis the overlapped mask cells are a box. The row is the union of these boxes. The moments themselves
// add nothing: cells that half-open cells overlap at a moment, they overlap just before or after it too.
//
// Half-open is what makes the mask hold the floor cell of every point of a segment from the begin to the end cell:
// a point of a moving half-open cell [X, X+w) lies in the half-open mask cell [m, m+a) only if m < X+w and X < m+a.
#include "model/cull/ray_mask_table.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "model/cull/cell_bits.h"
#include "model/cull/table_limit.h"

namespace ctu::cull {
namespace {

/// The run of mask cells overlapped until `end`.
struct Step {
  std::int64_t end;
  int first, last;
};
using AxisSweep = std::vector<Step>;

/// The sweeps of one axis for every begin and end cell, on one integer time scale.
class AxisSweeps {
 public:
  AxisSweeps(int resolution, int ray_resolution) : ray_resolution_(ray_resolution) {
    const std::int64_t units = std::lcm(resolution, ray_resolution);
    mask_width_ = units / resolution;
    ray_width_ = units / ray_resolution;
    std::int64_t distances = 1;  // crossings happen at multiples of 1 / (distance in cells * cell width)
    for (int d = 2; d < ray_resolution; ++d) distances = std::lcm(distances, std::int64_t{d});
    scale_ = distances * ray_width_;
    for (int end = 0; end < ray_resolution; ++end)
      for (int begin = 0; begin < ray_resolution; ++begin) sweeps_.push_back(sweep(begin, end));
  }

  const AxisSweep& of(int begin, int end) const {
    return sweeps_[static_cast<std::size_t>(begin + ray_resolution_ * end)];
  }

 private:
  AxisSweep sweep(std::int64_t begin, std::int64_t end) const {
    const std::int64_t from = begin * ray_width_, distance = (end - begin) * ray_width_;
    std::vector<std::int64_t> moments{scale_};
    if (distance != 0) {
      for (std::int64_t at = 1; at < std::abs(distance); ++at) {
        const std::int64_t low = from + (distance > 0 ? at : -at);
        if (low % mask_width_ == 0 || (low + ray_width_) % mask_width_ == 0)
          moments.push_back(at * (scale_ / std::abs(distance)));
      }
    }
    std::sort(moments.begin(), moments.end());
    AxisSweep steps;
    std::int64_t start = 0;
    for (const std::int64_t moment : moments) {
      // At the middle of the step, in units of 1 / (2 scale).
      const std::int64_t low = 2 * scale_ * from + (start + moment) * distance;
      const std::int64_t high = low + 2 * scale_ * ray_width_, cell = 2 * scale_ * mask_width_;
      steps.push_back({moment, static_cast<int>(low / cell), static_cast<int>((high + cell - 1) / cell) - 1});
      start = moment;
    }
    return steps;
  }

  int ray_resolution_;
  std::int64_t mask_width_, ray_width_, scale_;
  std::vector<AxisSweep> sweeps_;
};

/// Union of the boxes between the moments of all three axes.
template <int R>
void sweep_row(const AxisSweep& x, const AxisSweep& y, const AxisSweep& z, std::uint64_t* row) {
  const Step *a = x.data(), *b = y.data(), *c = z.data();
  const std::int64_t end = x.back().end;
  while (true) {
    const MaskWords<R> cells = box_of_cells<R>({{a->first, b->first, c->first}, {a->last, b->last, c->last}});
    for (int w = 0; w < kWords<R>; ++w) row[w] |= cells[w];
    const std::int64_t moment = std::min({a->end, b->end, c->end});
    if (moment == end) return;
    a += a->end == moment;
    b += b->end == moment;
    c += c->end == moment;
  }
}

template <int R>
void sweep_all(const AxisSweeps& sweeps, int n, std::uint64_t* row) {
  for (int ez = 0; ez < n; ++ez)
    for (int ey = 0; ey < n; ++ey)
      for (int ex = 0; ex < n; ++ex)
        for (int bz = 0; bz < n; ++bz)
          for (int by = 0; by < n; ++by)
            for (int bx = 0; bx < n; ++bx, row += kWords<R>)
              sweep_row<R>(sweeps.of(bx, ex), sweeps.of(by, ey), sweeps.of(bz, ez), row);
}

}  // namespace

void RayMaskTable::require_fits(int resolution, int ray_resolution) {
  validate({.resolution = resolution, .ray_resolution = ray_resolution});
  require_table_fits(
      "ray-mask table", ray_resolution, "R_ray^6 masks of R = " + std::to_string(resolution),
      8 * std::uint64_t{key_count(ray_resolution)} * static_cast<unsigned>(words_per_mask(resolution)),
      "choose a smaller R_ray, or the design `projection`, which gives the same masks from R_ray^4 rows");
}

RayMaskTable::RayMaskTable(int resolution, int ray_resolution)
    : resolution_(resolution),
      ray_resolution_(ray_resolution),
      words_(words_per_mask(resolution)),
      rows_(key_count(ray_resolution)) {
  require_fits(resolution, ray_resolution);
  bits_.resize(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(words_));
  const AxisSweeps sweeps(resolution, ray_resolution);
  with_resolution(resolution, [&](auto r) { sweep_all<r()>(sweeps, ray_resolution_, bits_.data()); });
}

}  // namespace ctu::cull
