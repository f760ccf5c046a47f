// Random numbers of generated scenes: Philox 4x32-10, a pure function of seed, item and draw. The order in which items
// are made cannot matter, and the numbers are the same on every platform.
// Source: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>

#include "model/scene/vector64.h"

namespace ctu::scene {

class Random {
 public:
  /// The numbers of item `item` of stream `stream`; items and streams are independent of each other.
  Random(std::uint64_t seed, std::uint64_t item, std::uint32_t stream = 0)
      : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
        counter_{{0, stream, static_cast<std::uint32_t>(item), static_cast<std::uint32_t>(item >> 32)}} {}

  std::uint32_t bits() {
    if (used_ == 4) {
      block_ = r123::Philox4x32()(counter_, key_);
      ++counter_.v[0];
      used_ = 0;
    }
    return block_.v[used_++];
  }

  /// Uniform in [0, 1), a multiple of 2^-32.
  double unit() { return bits() * 0x1p-32; }
  /// Uniform in [low, high).
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// Uniform in the unit ball, by rejection: no libm function is involved.
  Vector64 in_ball() {
    for (;;) {
      const Vector64 v{between(-1, 1), between(-1, 1), between(-1, 1)};
      if (dot(v, v) <= 1) return v;
    }
  }
  /// Uniform on the unit sphere.
  Vector64 direction() {
    for (;;) {
      const Vector64 v = in_ball();
      const double squared = dot(v, v);
      if (squared > 0x1p-20) return v * (1 / std::sqrt(squared));
    }
  }

 private:
  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_;
  r123::Philox4x32::ctr_type block_{};
  unsigned used_ = 4;
};

}  // namespace ctu::scene
