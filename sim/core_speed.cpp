#include "sim/core_speed.h"

#include <cstdint>

#include "sim/stopwatch.h"

namespace ctu::sim {

double core_speed() {
  constexpr int kAdditions = 10'000'000;
  std::uint64_t sum = 0, one = 1;
  const Stopwatch wall;
  for (int i = 0; i < kAdditions; ++i) {
    asm volatile("" : "+r"(sum), "+r"(one));  // neither may be known, or the loop would be a multiplication
    sum += one;
  }
  return kAdditions / wall.seconds() * 1e-9;
}

}  // namespace ctu::sim
