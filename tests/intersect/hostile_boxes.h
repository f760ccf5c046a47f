// Rays and boxes that break slab tests: flat boxes, origins on faces, direction components of every kind of smallness,
// boxes far away for their size, coordinates near binary32's ends.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "model/intersect/slab_test.h"

namespace ctu::intersect {

struct BoxCase {
  Ray ray;
  Box4 boxes;
  float tmax = 0;  ///< the best hit so far
};

class HostileBoxes {
 public:
  explicit HostileBoxes(std::uint64_t seed) : bits_(seed) {}
  BoxCase next();

 private:
  double uniform(double from, double to);
  bool chance(double share) { return uniform(0, 1) < share; }
  float signed_power_of_ten(double from, double to);
  float any_finite();
  float direction_component();
  void place_box(Box4& boxes, int lane, double size, double offset);

  std::mt19937_64 bits_;
};

/// The exact bits of one lane of the case, for failure messages.
std::string show(const BoxCase& box_case, int lane);

}  // namespace ctu::intersect
