// Random numbers of hard cases, counter-based as those of generated scenes are: what a scene is made of depends on the
// seed, the generator and the scene's number alone, so any scene can be made again by itself, on every platform.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model/scene/random.h"

namespace ctu::sim::check {

class CaseRandom {
 public:
  CaseRandom(std::uint64_t seed, std::uint32_t generator, std::uint64_t scene)
      : random_(seed, scene, kFirstStream + generator) {}

  std::uint32_t bits() { return random_.bits(); }
  /// Uniform in [0, 1), a multiple of 2^-32.
  double unit() { return random_.unit(); }
  double between(double low, double high) { return random_.between(low, high); }
  bool chance(double share) { return random_.unit() < share; }
  /// 0 .. count-1, for counts far below 2^32.
  int below(int count) { return static_cast<int>(static_cast<std::uint64_t>(random_.bits()) * count >> 32); }
  /// least .. most, both included.
  int pick(int least, int most) { return least + below(most - least + 1); }
  /// One of a list.
  template <class T, std::size_t kCount>
  const T& one_of(const T (&list)[kCount]) {
    return list[below(static_cast<int>(kCount))];
  }
  double either_sign(double x) { return (bits() & 1) != 0 ? x : -x; }
  /// 2^x for x uniform in [low, high), to within the roundness of powers of two: a significand uniform in [1, 2).
  double scale(int low, int high) {
    const int exponent = pick(low, high - 1);
    return std::ldexp(1 + unit(), exponent);
  }
  /// Uniform on the unit sphere.
  scene::Vector64 direction() { return random_.direction(); }

 private:
  static constexpr std::uint32_t kFirstStream = 0x43000000;  ///< apart from the streams of generated scenes

  scene::Random random_;
};

}  // namespace ctu::sim::check
