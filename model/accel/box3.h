// Axis-aligned boxes in four-float vectors, for the builder: x, y, z and one lane that carries something else.
#pragma once

#include <emmintrin.h>

#include <limits>

#include "model/numeric/vec3.h"

namespace ctu::accel {

struct Box3 {
  __m128 lower, upper;

  /// Holds nothing; growing it by a box gives that box.
  static Box3 empty() {
    const __m128 infinity = _mm_set1_ps(std::numeric_limits<float>::infinity());
    return {infinity, _mm_sub_ps(_mm_setzero_ps(), infinity)};
  }
  void grow(__m128 point) {
    lower = _mm_min_ps(lower, point);
    upper = _mm_max_ps(upper, point);
  }
  void grow(const Box3& other) {
    lower = _mm_min_ps(lower, other.lower);
    upper = _mm_max_ps(upper, other.upper);
  }
};

inline __m128 to_vector(const Vec3& v) { return _mm_setr_ps(v.x, v.y, v.z, 0.0f); }

/// Half the surface area, the measure of the surface area heuristic. The box must not be empty.
inline float half_area(const Box3& box) {
  const __m128 d = _mm_sub_ps(box.upper, box.lower);
  const __m128 next = _mm_shuffle_ps(d, d, _MM_SHUFFLE(3, 0, 2, 1));  // y z x
  const __m128 faces = _mm_mul_ps(d, next);
  const __m128 y = _mm_shuffle_ps(faces, faces, 1);
  const __m128 z = _mm_movehl_ps(faces, faces);
  return _mm_cvtss_f32(_mm_add_ss(_mm_add_ss(faces, y), z));
}

}  // namespace ctu::accel
