// Enclosures of the inner cell planes of one axis: where on the ray (from the times of the two faces) or where in
// space (from the two faces themselves). Plane k of R lies at ((R-k) first + k second) / R, which grows with both
// arguments, so directed rounding of a lower pair gives a lower bound and of an upper pair an upper bound.
//
// The arithmetic, twin of the unit's: each bound is add(mul(w, first), mul(v, second)), all three rounded in the
// bound's direction; w = (R-k)/R and v = k/R are constants, of which the neighbour is taken that moves the product
// outward (decided by the operand's sign; one constant when R is a power of two).
//
// No NaN arises. The constants are neither zero nor infinite, so no product is invalid. A lower bound's operands are
// below +infinity (rounding down never gives +infinity from a finite exact time) and an upper bound's are above
// -infinity, so no sum is infinity minus infinity. Faces of boxes are finite.
#pragma once

#include "model/cull/options.h"
#include "model/numeric/lanes.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace ctu::cull {

using numeric::Float4;
using numeric::Round;

inline constexpr int kPlaneGroups = kMaxRayResolution / 4;

/// Groups of four that R - 1 inner planes take.
constexpr int plane_groups(int resolution) { return (resolution + 2) / 4; }

/// Element k - 1 belongs to plane k; elements past the last plane repeat it and mean nothing.
struct LerpWeights {
  Float4 first_down[kPlaneGroups], first_up[kPlaneGroups];    ///< around (R-k)/R
  Float4 second_down[kPlaneGroups], second_up[kPlaneGroups];  ///< around k/R
};
const LerpWeights& lerp_weights(int resolution);

template <Round M>
Float4 lerp_planes(const LerpWeights& weights, int group, float first, float second) {
  constexpr bool kDown = M == Round::Down;
  const Float4 w = (first < 0) == kDown ? weights.first_up[group] : weights.first_down[group];
  const Float4 v = (second < 0) == kDown ? weights.second_up[group] : weights.second_down[group];
  return numeric::add<M>(numeric::mul<M>(w, numeric::splat(first)), numeric::mul<M>(v, numeric::splat(second)));
}

/// Bit i: element i of the mask is set.
inline unsigned set_lanes(numeric::Mask4 mask) {
#if defined(__SSE__)
  return static_cast<unsigned>(_mm_movemask_ps(std::bit_cast<__m128>(mask)));
#else
  return numeric::lane_set(mask);
#endif
}

}  // namespace ctu::cull
