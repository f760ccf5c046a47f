// Influence areas found from rays alone, without being told where the lights are: the paper leaves this open.
//
// Rays that next-event estimation sends agree on a light: on a focal point that their lines pass, or on a direction.
// Two of them are enough to guess which (where their lines are nearest to each other, or their mean direction), so
// lights are found as models are in RANSAC (Fischler and Bolles 1981): guesses from pairs, each weighed by how many
// rays agree, the best one fitted to all of these by least squares; then the same on the rays that are left. The rays
// of one light are enclosed in a box along their direction, or in frusta from a point just behind the focal point, so
// that it lies inside and a ray that reaches the light never leaves the area: in one, or in one for each side of a cube
// around the light when they come from all around. Everything is a function of the rays and the seed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/influence/area.h"

namespace ctu::influence {

struct FindOptions {
  int most_areas = 16;
  double least_share = 0.02;       ///< of the rays, for an area to be worth a tree
  double tolerance_degrees = 0.5;  ///< between a ray and the rays of the light that it is given to
  int guesses = 96;                ///< for each light
  std::size_t most_rays = 4096;    ///< looked at, evenly from all
  double margin = 0.01;            ///< by which areas are wider than the rays that were looked at need
  std::uint64_t seed = 1;
};

struct FoundArea {
  InfluenceArea area;
  std::uint64_t rays = 0;  ///< of those looked at
};

struct FoundAreas {
  std::vector<FoundArea> areas;  ///< of the light with most rays first
  std::uint64_t looked_at = 0;
  std::uint64_t unclaimed = 0;  ///< rays of no area
  std::vector<InfluenceArea> list() const;
};

/// `lower` and `upper` bound the scene: rays count up to where they leave it. Rays that are not valid are passed over.
/// Throws Error on options out of range.
FoundAreas find_areas(std::span<const intersect::Ray> rays, const Vec3& lower, const Vec3& upper,
                      const FindOptions& options = {});

}  // namespace ctu::influence
