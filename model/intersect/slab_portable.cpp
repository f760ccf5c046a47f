// The slab test as slab_test.cpp argues it, in portable vector arithmetic: each bound by the operations of lanes.h.

#include <limits>

#include "model/intersect/slab_kernels.h"

namespace ctu::intersect::portable {

using numeric::Float4;
using numeric::Mask4;
using numeric::Round;
using numeric::splat;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// max and min of lanes that hold no NaN: -0 orders before +0.
Float4 later(Float4 a, Float4 b) {
  return numeric::from_lane_bits(numeric::lane_bits(a > b ? a : b) & numeric::lane_bits(b > a ? b : a));
}
Float4 earlier(Float4 a, Float4 b) {
  return numeric::from_lane_bits(numeric::lane_bits(a < b ? a : b) | numeric::lane_bits(b < a ? b : a));
}

/// One axis of the ray, mirrored so that it moves upwards.
struct Axis {
  Float4 origin, rcp_small, rcp_large;
  std::int32_t flip;  ///< the sign bit if the axis was mirrored

  Axis(const PreparedRay& ray, int axis) {
    const bool negative = ray.negative_axes >> axis & 1;
    flip = negative ? numeric::detail::kSignBit : 0;
    origin = mirrored(splat(ray.ray.origin[axis]));
    rcp_small = splat(negative ? -ray.rcp_up[axis] : ray.rcp_down[axis]);
    rcp_large = splat(negative ? -ray.rcp_down[axis] : ray.rcp_up[axis]);
  }
  Float4 mirrored(Float4 x) const { return numeric::from_lane_bits(numeric::lane_bits(x) ^ flip); }
};

template <Round M>
Float4 time_at(const Axis& axis, Float4 plane) {
  const Float4 distance = numeric::portable::sub<M>(axis.mirrored(plane), axis.origin);
  const bool down = M == Round::Down;
  const Float4 rcp =
      distance >= 0 ? (down ? axis.rcp_small : axis.rcp_large) : (down ? axis.rcp_large : axis.rcp_small);
  const Float4 time = numeric::portable::mul<M>(distance, rcp);
  return distance == 0 ? splat(0.0f) : time;
}

/// Both public forms: kInner also computes and stores the bounds that face inwards.
template <bool kInner>
void slab(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out) {
  Float4 t0 = splat(ray.ray.tmin), t1 = splat(tmax);
  for (int i = 0; i < 3; ++i) {
    const Float4 lo = numeric::load4(boxes.lo[i]), hi = numeric::load4(boxes.hi[i]);
    Float4 near_down, near_up, far_down, far_up;
    if (ray.zero_axes >> i & 1) {
      const Float4 origin = splat(ray.ray.origin[i]);
      const Mask4 inside = (lo <= origin) & (origin <= hi);
      near_down = near_up = inside ? splat(-kInfinity) : splat(kInfinity);
      far_down = far_up = -near_down;
    } else {
      const Axis axis(ray, i);
      const Float4 near = axis.flip ? hi : lo, far = axis.flip ? lo : hi;
      near_down = time_at<Round::Down>(axis, near);
      far_up = time_at<Round::Up>(axis, far);
      if constexpr (kInner) {
        near_up = time_at<Round::Up>(axis, near);
        far_down = time_at<Round::Down>(axis, far);
      }
    }
    t0 = later(t0, near_down);
    t1 = earlier(t1, far_up);
    if constexpr (kInner) {
      numeric::store4(out.near_down[i], near_down);
      numeric::store4(out.near_up[i], near_up);
      numeric::store4(out.far_down[i], far_down);
      numeric::store4(out.far_up[i], far_up);
    }
  }
  numeric::store4(out.t0, t0);
  numeric::store4(out.t1, t1);
  out.hit = static_cast<std::uint8_t>(numeric::lane_set(t0 <= t1));
}

}  // namespace

SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax) {
  SlabTimes out;
  slab<true>(ray, boxes, tmax, out);
  return out;
}

void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out) {
  slab<false>(ray, boxes, tmax, out);
}

}  // namespace ctu::intersect::portable
