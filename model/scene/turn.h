// Sine and cosine of a part of a full turn, with the same bits on every platform (libm's differ), exact at quarters.
#pragma once

#include <cmath>

namespace ctu::scene {

struct Turn {
  double cosine, sine;
};

/// `turns` = 1 is 360 degrees. Error below 4 units in the last place of 1.
inline Turn turn(double turns) {
  constexpr double kTwoPi = 6.283185307179586477;
  turns -= std::floor(turns);
  const double quarters = std::floor(turns * 4 + 0.5);
  const double angle = (turns - quarters * 0.25) * kTwoPi;  // within [-pi/4, pi/4]
  const double squared = angle * angle;
  double cosine = 0, sine = 0;
  for (int n = 18; n >= 2; n -= 2) {  // Taylor series, innermost term first; the term left out is below 2^-60
    cosine = (1 + cosine) * -squared / (n * (n - 1));
    sine = (1 + sine) * -squared / (n * (n + 1));
  }
  const double c = 1 + cosine, s = angle * (1 + sine);
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

}  // namespace ctu::scene
