// Conservative voxelization of a sphere into the closed cells of a box's R^3 grid: a cell touches the surface iff its
// nearest point to the centre is not outside the ball and its farthest is not inside (Arvo 1990, "A simple method for
// box-sphere intersection testing", both ways). Done in space, in binary64, where distances keep their meaning.
//
// With M the largest magnitude of the box's planes, the centre's coordinates and the radius, a plane of the grid is off
// by less than 2^-51 M and a distance on one axis by less than 2^-50 M; squares and their sums add relative errors
// below 2^-50. Distances are widened by 2^-48 M and squares by 2^-48, so no touched cell is lost.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "model/cull/cell_bits.h"
#include "model/cull/triangle_cells.h"
#include "model/scene/sphere.h"

namespace ctu::cull {
namespace detail {

/// On one axis, the squares of the least and greatest distances of each layer of cells from the centre.
template <int R>
struct LayerDistances {
  double least[R], most[R];

  LayerDistances(double lower, double upper, double centre, double margin) {
    for (int i = 0; i < R; ++i) {
      // A flat axis has R equal layers: what touches one touches all.
      const double low = lower + (upper - lower) * i / R - centre,
                   high = lower + (upper - lower) * (i + 1) / R - centre;
      const double near = std::max({low, -high, 0.0}) - margin, far = std::max(-low, high) + margin;
      least[i] = near > 0 ? near * near : 0;
      most[i] = far * far;
    }
  }
};

}  // namespace detail

/// Sets the bits of the closed cells of `box` that the sphere's surface touches.
template <int R>
void add_sphere(const Bounds& box, const scene::Sphere& sphere, std::uint64_t* mask) {
  constexpr double kRelative = 0x1p-48;
  double most = sphere.radius;
  for (int a = 0; a < 3; ++a)
    most = std::max(
        {most, std::fabs(double{box.lower[a]}), std::fabs(double{box.upper[a]}), std::fabs(double{sphere.centre[a]})});
  const auto distances = [&](int a) {
    return detail::LayerDistances<R>(box.lower[a], box.upper[a], sphere.centre[a], kRelative * most);
  };
  const detail::LayerDistances<R> x = distances(0), y = distances(1), z = distances(2);
  const double square = double{sphere.radius} * sphere.radius;
  for (int k = 0; k < R; ++k)
    for (int j = 0; j < R; ++j)
      for (int i = 0; i < R; ++i) {
        if (x.least[i] + y.least[j] + z.least[k] > square * (1 + kRelative)) continue;
        if (x.most[i] + y.most[j] + z.most[k] < square * (1 - kRelative)) continue;
        const auto cell = static_cast<std::size_t>(i + R * (j + R * k));
        mask[cell / 64] |= std::uint64_t{1} << (cell % 64);
      }
}

}  // namespace ctu::cull
