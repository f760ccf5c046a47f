// Eight binary32 side by side: one AVX register where there is one, two SSE registers elsewhere.
#pragma once

#include <immintrin.h>

namespace ctu::reference {

#ifdef __AVX__

struct Lanes8 {
  __m256 v;
};
inline Lanes8 splat8(float x) { return {_mm256_set1_ps(x)}; }
inline Lanes8 load8(const float* aligned) { return {_mm256_load_ps(aligned)}; }
inline void store8(float* aligned, Lanes8 x) { _mm256_store_ps(aligned, x.v); }
inline Lanes8 min8(Lanes8 a, Lanes8 b) { return {_mm256_min_ps(a.v, b.v)}; }
inline Lanes8 max8(Lanes8 a, Lanes8 b) { return {_mm256_max_ps(a.v, b.v)}; }
/// a * b + c, rounded once or twice as the processor does it.
inline Lanes8 multiply_add8(Lanes8 a, Lanes8 b, Lanes8 c) {
#ifdef __FMA__
  return {_mm256_fmadd_ps(a.v, b.v, c.v)};
#else
  return {_mm256_add_ps(_mm256_mul_ps(a.v, b.v), c.v)};
#endif
}
/// Bit lane: a <= b.
inline unsigned less_equal8(Lanes8 a, Lanes8 b) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}

#else

struct Lanes8 {
  __m128 low, high;
};
inline Lanes8 splat8(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
inline Lanes8 load8(const float* aligned) { return {_mm_load_ps(aligned), _mm_load_ps(aligned + 4)}; }
inline void store8(float* aligned, Lanes8 x) {
  _mm_store_ps(aligned, x.low);
  _mm_store_ps(aligned + 4, x.high);
}
inline Lanes8 min8(Lanes8 a, Lanes8 b) { return {_mm_min_ps(a.low, b.low), _mm_min_ps(a.high, b.high)}; }
inline Lanes8 max8(Lanes8 a, Lanes8 b) { return {_mm_max_ps(a.low, b.low), _mm_max_ps(a.high, b.high)}; }
/// a * b + c, rounded once or twice as the processor does it.
inline Lanes8 multiply_add8(Lanes8 a, Lanes8 b, Lanes8 c) {
  return {_mm_add_ps(_mm_mul_ps(a.low, b.low), c.low), _mm_add_ps(_mm_mul_ps(a.high, b.high), c.high)};
}
/// Bit lane: a <= b.
inline unsigned less_equal8(Lanes8 a, Lanes8 b) {
  return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.low, b.low)) |
                               _mm_movemask_ps(_mm_cmple_ps(a.high, b.high)) << 4);
}

#endif

}  // namespace ctu::reference
