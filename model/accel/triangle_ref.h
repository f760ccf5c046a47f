// What the builder moves about instead of triangles: the box and the id, 32 bytes.
#pragma once

#include <cstdint>

#include "model/accel/box3.h"

namespace ctu::accel {

/// The fourth lane of `box.lower` holds the id, that of `box.upper` is unused. The id is stored with an offset that
/// makes its bits a normal number: arithmetic on whole vectors would be slow on subnormals.
struct TriangleRef {
  Box3 box;

  static constexpr std::uint32_t kIdOffset = 0x3f000000u;

  static TriangleRef make(const Box3& box, std::uint32_t id) {
    const __m128 xyz = _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0));
    const __m128 tag = _mm_castsi128_ps(_mm_setr_epi32(0, 0, 0, static_cast<int>(id + kIdOffset)));
    return {{_mm_or_ps(_mm_and_ps(box.lower, xyz), tag), _mm_and_ps(box.upper, xyz)}};
  }
  std::uint32_t id() const {
    const __m128i bits = _mm_castps_si128(box.lower);
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_shuffle_epi32(bits, 0xff))) - kIdOffset;
  }
  /// Twice the centre of the box.
  __m128 centre2() const { return _mm_add_ps(box.lower, box.upper); }
  float centre2(int axis) const {
    alignas(16) float c[4];
    _mm_store_ps(c, centre2());
    return c[axis];
  }
};
static_assert(sizeof(TriangleRef) == 32);

}  // namespace ctu::accel
