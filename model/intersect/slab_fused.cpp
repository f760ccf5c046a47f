// The slab test with AVX2 and fused multiply-adds, all in binary32. A register holds an axis: the near planes of four
// boxes, and the far planes with their signs flipped, so that [near | -far] wants the same bound in every lane.
//
// The error of a difference is TwoSum's (exact), that of a product one fused multiply-add away (exact from 2^-100 up);
// a neighbour is one step of the bits. Where either may not hold - differences from 2^126, products below 2^-100 -
// the portable form answers instead. A sum that rounds to zero is exact, so no step ever starts from zero.
#include "model/intersect/slab_kernels.h"

#if CTU_FUSED_SLAB

#include <immintrin.h>

#include <limits>

namespace ctu::intersect::fused {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

__m256 sign_bits() { return _mm256_set1_ps(-0.0f); }
__m256 magnitude(__m256 x) { return _mm256_andnot_ps(sign_bits(), x); }
__m256 swap_halves(__m256 x) { return _mm256_permute2f128_ps(x, x, 1); }
__m256 negate_high(__m256 x) { return _mm256_xor_ps(x, _mm256_setr_ps(0, 0, 0, 0, -0.0f, -0.0f, -0.0f, -0.0f)); }
__m256 two_halves(const float* low, const float* high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);
}
__m256 is_less(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }

/// max of lanes that hold no NaN: -0 orders before +0.
__m256 later(__m256 a, __m256 b) { return _mm256_and_ps(_mm256_max_ps(a, b), _mm256_max_ps(b, a)); }

/// One place down (or up) on the binary32 line in the lanes of `where`; not from zero.
template <bool kDown>
__m256 step(__m256 x, __m256 where) {
  const __m256i from = _mm256_castps_si256(x);
  const __m256i outward = _mm256_or_si256(_mm256_srai_epi32(from, 31), _mm256_set1_epi32(1));
  const __m256i by = _mm256_and_si256(outward, _mm256_castps_si256(where));
  return _mm256_castsi256_ps(kDown ? _mm256_sub_epi32(from, by) : _mm256_add_epi32(from, by));
}

/// plane - origin to nearest, and its exact error.
struct Distance {
  __m256 nearest, error;

  Distance(__m256 plane, __m256 origin) {
    nearest = _mm256_sub_ps(plane, origin);
    const __m256 rest = _mm256_sub_ps(plane, nearest);  // about origin
    error = _mm256_sub_ps(_mm256_sub_ps(plane, _mm256_add_ps(nearest, rest)), _mm256_sub_ps(origin, rest));
  }
};

struct Axis {
  __m256 origin, rcp_small, rcp_large;
  bool negative;

  Axis(const PreparedRay& ray, int axis) {
    negative = ray.negative_axes >> axis & 1;
    origin = arranged(negate_high(_mm256_set1_ps(ray.ray.origin[axis])));
    rcp_small = _mm256_set1_ps(negative ? -ray.rcp_up[axis] : ray.rcp_down[axis]);
    rcp_large = _mm256_set1_ps(negative ? -ray.rcp_down[axis] : ray.rcp_up[axis]);
  }
  /// From [x | -x] of the axis as it is to that of the mirrored one.
  __m256 arranged(__m256 x) const { return negative ? swap_halves(x) : x; }
};

/// A bound of the times, and `doubt` set where it may be wrong.
template <bool kDown>
__m256 time_bound(const Axis& axis, const Distance& exact, __m256& doubt) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256 inexact = kDown ? is_less(exact.error, zero) : is_less(zero, exact.error);
  const __m256 distance = step<kDown>(exact.nearest, inexact);
  const __m256 behind = is_less(distance, zero), moves = _mm256_cmp_ps(distance, zero, _CMP_NEQ_OQ);
  const __m256 rcp = kDown ? _mm256_blendv_ps(axis.rcp_small, axis.rcp_large, behind)
                           : _mm256_blendv_ps(axis.rcp_large, axis.rcp_small, behind);
  const __m256 product = _mm256_mul_ps(distance, rcp), error = _mm256_fmsub_ps(distance, rcp, product);
  const __m256 tiny = is_less(magnitude(product), _mm256_set1_ps(0x1p-100f));
  doubt = _mm256_or_ps(doubt, _mm256_and_ps(tiny, moves));
  const __m256 time = step<kDown>(product, kDown ? is_less(error, zero) : is_less(zero, error));
  return _mm256_blendv_ps(negate_high(zero), time, moves);  // t = +0 at a distance of zero
}

/// Stores x = [near | -far].
void store(float* near, float* far, __m256 x) {
  _mm_storeu_ps(near, _mm256_castps256_ps128(x));
  _mm_storeu_ps(far, _mm256_extractf128_ps(_mm256_xor_ps(x, sign_bits()), 1));
}

/// [near | -far] of an axis that the ray does not move along: a comparison decides.
__m256 standing(const PreparedRay& ray, const Box4& boxes, int axis) {
  const __m128 origin = _mm_set1_ps(ray.ray.origin[axis]);
  const __m128 inside = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(boxes.lo[axis]), origin),
                                   _mm_cmple_ps(origin, _mm_loadu_ps(boxes.hi[axis])));
  const __m128 time = _mm_or_ps(_mm_set1_ps(kInfinity), _mm_and_ps(inside, _mm_set1_ps(-0.0f)));
  return _mm256_set_m128(time, time);
}

/// Both public forms; false where the portable one must answer.
template <bool kInner>
bool slab(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out) {
  __m256 span = _mm256_set_m128(_mm_set1_ps(-tmax), _mm_set1_ps(ray.ray.tmin));  // [t0 | -t1]
  __m256 doubt = _mm256_setzero_ps();
  for (int i = 0; i < 3; ++i) {
    __m256 outer, inner;  // [near_down | -far_up], [near_up | -far_down]
    if (ray.zero_axes >> i & 1) {
      outer = inner = standing(ray, boxes, i);
    } else {
      const Axis axis(ray, i);
      const __m256 plane = axis.arranged(negate_high(two_halves(boxes.lo[i], boxes.hi[i])));
      const Distance distance(plane, axis.origin);
      const __m256 huge = is_less(_mm256_set1_ps(0x1p126f), magnitude(distance.nearest));
      doubt = _mm256_or_ps(doubt, _mm256_and_ps(huge, is_less(plane, _mm256_set1_ps(kInfinity))));  // empty lanes: +inf
      outer = time_bound<true>(axis, distance, doubt);
      if constexpr (kInner) inner = time_bound<false>(axis, distance, doubt);
    }
    span = later(span, outer);
    if constexpr (kInner) {
      store(out.near_down[i], out.far_up[i], outer);
      store(out.near_up[i], out.far_down[i], inner);
    }
  }
  if (_mm256_movemask_ps(doubt) != 0) return false;
  store(out.t0, out.t1, span);
  out.hit = static_cast<std::uint8_t>(_mm_movemask_ps(_mm_cmple_ps(_mm_loadu_ps(out.t0), _mm_loadu_ps(out.t1))));
  return true;
}

}  // namespace

SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax) {
  SlabTimes out;
  if (!slab<true>(ray, boxes, tmax, out)) out = portable::slab_test(ray, boxes, tmax);
  return out;
}

void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out) {
  if (!slab<false>(ray, boxes, tmax, out)) portable::slab_test_outer(ray, boxes, tmax, out);
}

}  // namespace ctu::intersect::fused

#endif
