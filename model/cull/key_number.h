// The number of a key among all R_ray^6: begin x fastest, then begin y, z, end x, y, z.
#pragma once

#include <cstdint>

#include "model/cull/cell_locate.h"

namespace ctu::cull {

/// R_ray^6, which 32 bits hold for every R_ray.
constexpr std::uint32_t key_count(int ray_resolution) {
  const auto n = static_cast<std::uint32_t>(ray_resolution);
  return n * n * n * n * n * n;
}

inline std::uint32_t key_number(CellKey key, int ray_resolution) {
  const auto n = static_cast<std::uint32_t>(ray_resolution);
  std::uint32_t number = 0;
  for (int axis = 2; axis >= 0; --axis) number = number * n + static_cast<std::uint32_t>(key.end(axis));
  for (int axis = 2; axis >= 0; --axis) number = number * n + static_cast<std::uint32_t>(key.begin(axis));
  return number;
}

inline CellKey numbered_key(std::uint32_t number, int ray_resolution) {
  const auto n = static_cast<std::uint32_t>(ray_resolution);
  CellKey key;
  for (int field = 0; field < 6; ++field, number /= n) key.packed |= number % n << (5 * field);
  return key;
}

/// Begin and end exchanged: the same ray backwards, which sweeps the same cells.
constexpr CellKey reversed(CellKey key) { return {key.packed >> 15 | (key.packed & 0x7FFFu) << 15}; }

}  // namespace ctu::cull
