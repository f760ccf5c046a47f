// Split clipping: the box of what of a primitive lies on one side of a plane. Source: Havran, "Heuristic ray shooting
// algorithms", thesis, Prague 2000.
#pragma once

#include <optional>

#include "model/accel/kd_tree.h"

namespace ctu::accel {

enum class Side : std::uint8_t { Lower, Upper };

/// A box within `box` that holds every point of the primitive that lies in `box` and on that side of x[axis] = plane,
/// the plane included; nothing if there is none. Points are computed in binary64, widened by more than their error, and
/// rounded outward.
std::optional<PrimitiveBox> clipped_box(const LeafTriangle& primitive, const PrimitiveBox& box, int axis, float plane,
                                        Side side);

}  // namespace ctu::accel
