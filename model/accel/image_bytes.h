// Little-endian words in the bytes of an image, whatever the host is.
#pragma once

#include <bit>
#include <cstdint>

namespace ctu::accel {

inline void store_u32(std::uint8_t* p, std::uint32_t x) {
  for (int i = 0; i < 4; ++i) p[i] = static_cast<std::uint8_t>(x >> (8 * i));
}
inline std::uint32_t load_u32(const std::uint8_t* p) {
  return p[0] | static_cast<std::uint32_t>(p[1]) << 8 | static_cast<std::uint32_t>(p[2]) << 16 |
         static_cast<std::uint32_t>(p[3]) << 24;
}
inline void store_float(std::uint8_t* p, float x) { store_u32(p, std::bit_cast<std::uint32_t>(x)); }
inline float load_float(const std::uint8_t* p) { return std::bit_cast<float>(load_u32(p)); }

}  // namespace ctu::accel
