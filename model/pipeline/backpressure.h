// Refusals at will, for tests: a latency-insensitive unit gives the same answers under any of them.
#pragma once

#include <cstdint>

#include "model/pipeline/cycle.h"

namespace ctu::pipeline {

/// Bijective mixing of 64 bits (the finaliser of splitmix64): enough to make a counter look random.
inline std::uint64_t mix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

/// Which side of a link asks.
enum class Side : std::uint8_t { Pop = 0, Push = 1 };

/// Whether a link refuses is a function of (seed, link, side, cycle) alone, so that asking twice, or in another order,
/// gives the same answer.
struct Backpressure {
  std::uint64_t seed = 0;  ///< 0: nobody refuses
  int stuck_link = -1;     ///< this link never accepts a push: a planted deadlock

  bool any() const { return seed != 0 || stuck_link >= 0; }
  bool refuses(int link, Side side, Cycle now) const {
    if (link == stuck_link && side == Side::Push) return true;
    if (seed == 0) return false;
    const std::uint64_t key = mix64(seed + static_cast<std::uint64_t>(link) * 2 + static_cast<std::uint64_t>(side));
    return (mix64(key ^ now) & 3u) == 0;
  }
};

}  // namespace ctu::pipeline
