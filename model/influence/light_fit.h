// Which light a bundle of rays comes from: a focal point, or a direction.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "model/influence/area.h"
#include "model/scene/vector64.h"

namespace ctu::influence {

/// A ray as the fit sees it: from `origin` along the unit vector `direction`, to `end`.
struct Sight {
  scene::Vector64 origin, direction, end;
};

struct Light {
  AreaKind kind = AreaKind::Plane;
  scene::Vector64 place;  ///< the focal point, or the unit vector that rays run along
};

/// Whether the ray runs towards the focal point, or along the direction, within the angle.
bool agrees(const Light& light, const Sight& sight, double least_cosine);

/// Positions in `sights` of those that agree.
std::vector<std::uint32_t> agreeing(const Light& light, std::span<const Sight> sights, double least_cosine);

/// The point with the least sum of squared distances from the lines; none when they are parallel.
std::optional<scene::Vector64> nearest_point(std::span<const Sight> sights, std::span<const std::uint32_t> chosen);

/// The light on which most rays agree, of `guesses` from pairs of rays, then fitted to those. A direction is preferred
/// to a focal point on which no more rays agree. None when fewer than `least_rays` agree on any.
std::optional<Light> find_light(std::span<const Sight> sights, int guesses, std::size_t least_rays, double least_cosine,
                                std::uint64_t seed, std::uint64_t round);

}  // namespace ctu::influence
