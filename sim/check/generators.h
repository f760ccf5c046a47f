// The generators by family; generators() of hard_case.h strings them together in this order.
#pragma once

#include <span>

#include "sim/check/hard_case.h"

namespace ctu::sim::check {

std::span<const Generator> ray_direction_generators();
std::span<const Generator> ray_origin_generators();
std::span<const Generator> ray_interval_generators();
std::span<const Generator> aimed_ray_generators();
std::span<const Generator> box_shape_generators();
std::span<const Generator> scale_generators();
std::span<const Generator> mesh_generators();

}  // namespace ctu::sim::check
