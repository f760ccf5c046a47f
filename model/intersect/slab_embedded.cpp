// The slab test with AVX-512: twelve planes (three axes of four boxes) in one register, rounded by the instruction.
#include "model/intersect/slab_kernels.h"

#if CTU_EMBEDDED_ROUNDING

#include <limits>

namespace ctu::intersect::embedded {

using numeric::Round;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr __mmask16 kTwelve = 0x0fff;  // lanes 4a .. 4a+3 are axis a

/// The lanes of a set of axes, by its bits.
constexpr __mmask16 kLanesOf[8] = {0x000, 0x00f, 0x0f0, 0x0ff, 0xf00, 0xf0f, 0xff0, 0xfff};

__m512 four_of_each(const Vec3& v) {
  const __m512i axis = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 0, 0, 0, 0);
  return _mm512_maskz_permutexvar_ps(numeric::embedded::kAll, axis,
                                     _mm512_castps128_ps512(_mm_maskz_loadu_ps(7, &v.x)));
}

/// All three axes of the ray, each mirrored so that it moves upwards.
struct Axes {
  __m512 origin, rcp_small, rcp_large;
  __m512i flip;
  __mmask16 negative, zero;

  explicit Axes(const PreparedRay& ray) {
    negative = kLanesOf[ray.negative_axes];
    zero = kLanesOf[ray.zero_axes];
    flip = _mm512_maskz_set1_epi32(negative, numeric::detail::kSignBit);
    origin = mirrored(four_of_each(ray.ray.origin));
    const __m512 down = four_of_each(ray.rcp_down), up = four_of_each(ray.rcp_up);
    rcp_small = mirrored(_mm512_mask_blend_ps(negative, down, up));
    rcp_large = mirrored(_mm512_mask_blend_ps(negative, up, down));
  }
  __m512 mirrored(__m512 x) const { return _mm512_castsi512_ps(_mm512_xor_si512(_mm512_castps_si512(x), flip)); }
};

__m512 lower_time(const Axes& axes, __m512 plane) {
  constexpr int kDown = numeric::embedded::kMode<Round::Down>;
  const __m512 distance = _mm512_maskz_sub_round_ps(numeric::embedded::kAll, plane, axes.origin, kDown);
  const __mmask16 moves = _mm512_cmp_ps_mask(distance, _mm512_setzero_ps(), _CMP_NEQ_OQ);
  const __mmask16 ahead = _mm512_cmp_ps_mask(distance, _mm512_setzero_ps(), _CMP_GE_OQ);
  return _mm512_maskz_mul_round_ps(moves, distance, _mm512_mask_blend_ps(ahead, axes.rcp_large, axes.rcp_small), kDown);
}

__m512 upper_time(const Axes& axes, __m512 plane) {
  constexpr int kUp = numeric::embedded::kMode<Round::Up>;
  const __m512 distance = _mm512_maskz_sub_round_ps(numeric::embedded::kAll, plane, axes.origin, kUp);
  const __mmask16 moves = _mm512_cmp_ps_mask(distance, _mm512_setzero_ps(), _CMP_NEQ_OQ);
  const __mmask16 ahead = _mm512_cmp_ps_mask(distance, _mm512_setzero_ps(), _CMP_GE_OQ);
  return _mm512_maskz_mul_round_ps(moves, distance, _mm512_mask_blend_ps(ahead, axes.rcp_small, axes.rcp_large), kUp);
}

template <int kAxis>
__m128 axis_lanes(__m512 x) {
  return _mm512_maskz_extractf32x4_ps(0xf, x, kAxis);
}

/// IEEE 754 max and min, -0 before +0: bits 1-0 choose the operation, bits 3-2 the sign that it gives.
__m128 later(__m128 a, __m128 b) { return _mm_range_ps(a, b, 0b0101); }
__m128 earlier(__m128 a, __m128 b) { return _mm_range_ps(a, b, 0b0100); }

template <bool kInner>
void slab(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out) {
  const Axes axes(ray);
  const __m512 lo = _mm512_maskz_loadu_ps(kTwelve, boxes.lo), hi = _mm512_maskz_loadu_ps(kTwelve, boxes.hi);
  const __m512 near = axes.mirrored(_mm512_mask_blend_ps(axes.negative, lo, hi));
  const __m512 far = axes.mirrored(_mm512_mask_blend_ps(axes.negative, hi, lo));
  __m512 near_down = lower_time(axes, near), far_up = upper_time(axes, far);
  // Where the ray does not move along an axis, a comparison decides; the other lanes keep their times.
  const __mmask16 inside =
      _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(lo, axes.origin, _CMP_LE_OQ), axes.origin, hi, _CMP_LE_OQ);
  const __m512 before = _mm512_mask_blend_ps(inside, _mm512_set1_ps(kInfinity), _mm512_set1_ps(-kInfinity));
  const __m512 after = _mm512_mask_blend_ps(inside, _mm512_set1_ps(-kInfinity), _mm512_set1_ps(kInfinity));
  near_down = _mm512_mask_mov_ps(near_down, axes.zero, before);
  far_up = _mm512_mask_mov_ps(far_up, axes.zero, after);
  if constexpr (kInner) {
    const __m512 near_up = _mm512_mask_mov_ps(upper_time(axes, near), axes.zero, before);
    const __m512 far_down = _mm512_mask_mov_ps(lower_time(axes, far), axes.zero, after);
    _mm512_mask_storeu_ps(out.near_down, kTwelve, near_down);
    _mm512_mask_storeu_ps(out.near_up, kTwelve, near_up);
    _mm512_mask_storeu_ps(out.far_down, kTwelve, far_down);
    _mm512_mask_storeu_ps(out.far_up, kTwelve, far_up);
  }
  const __m128 t0 = later(later(_mm_set1_ps(ray.ray.tmin), axis_lanes<0>(near_down)),
                          later(axis_lanes<1>(near_down), axis_lanes<2>(near_down)));
  const __m128 t1 =
      earlier(earlier(_mm_set1_ps(tmax), axis_lanes<0>(far_up)), earlier(axis_lanes<1>(far_up), axis_lanes<2>(far_up)));
  _mm_storeu_ps(out.t0, t0);
  _mm_storeu_ps(out.t1, t1);
  out.hit = static_cast<std::uint8_t>(_mm_cmp_ps_mask(t0, t1, _CMP_LE_OQ));
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

}  // namespace ctu::intersect::embedded

#endif
