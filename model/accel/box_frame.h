// Where a node's planes lie when each is stored in a few bits: the decoder of reduced precision (compressed wide nodes:
// Ylitie, Karras, Laine 2017, in our own layout).
//
// A node has one frame, its origin and on each axis a step that is a power of two. A plane is a whole number q of steps
// above the origin:
//
//   lower plane = origin + q * step, rounded down      upper plane = origin + q * step, rounded up
//
// q * step is exact for the 16 bits that q has at most, or infinite; a plane beyond binary32 is the largest finite
// number. Planes do not move down as q grows, so there is a q for whatever the encoder (quantize.h) needs.
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/box_decode_plane.sv.
#pragma once

#include <cstdint>
#include <limits>

#include "model/numeric/round.h"

namespace ctu::accel {

inline constexpr std::uint32_t kFullBoxBits = 32;       ///< of a coordinate: binary32, no frame
inline constexpr std::uint32_t kMaxStepExponent = 276;  ///< step 2^127, the largest power of two of binary32

struct BoxFrame {
  float origin[3] = {};
  std::uint32_t exponents = 0;  ///< 10 bits for each axis, x lowest

  std::uint32_t exponent(int axis) const { return exponents >> (10 * axis) & 1023u; }
  void set_exponent(int axis, std::uint32_t exponent) {
    exponents = (exponents & ~(1023u << (10 * axis))) | exponent << (10 * axis);
  }
};

/// 2^(exponent - 149): from the smallest subnormal number, 0, to 2^127, kMaxStepExponent.
inline float step_of(std::uint32_t exponent) {
  return numeric::from_bits(exponent < 23 ? 1u << exponent : (exponent - 22) << 23);
}

/// The plane at q steps above a finite origin, rounded towards M; never infinite.
template <numeric::Round M>
float decode_plane(float origin, std::uint32_t exponent, std::uint32_t q) {
  const float offset = numeric::mul<numeric::Round::Nearest>(static_cast<float>(q), step_of(exponent));
  return numeric::min(numeric::add<M>(origin, offset), std::numeric_limits<float>::max());
}

inline float decode_lower(float origin, std::uint32_t exponent, std::uint32_t q) {
  return decode_plane<numeric::Round::Down>(origin, exponent, q);
}
inline float decode_upper(float origin, std::uint32_t exponent, std::uint32_t q) {
  return decode_plane<numeric::Round::Up>(origin, exponent, q);
}

}  // namespace ctu::accel
