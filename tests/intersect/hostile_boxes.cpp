#include "tests/intersect/hostile_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "model/numeric/round.h"

namespace ctu::intersect {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float finite(double x) {
  const double most = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -most, most));
}

}  // namespace

double HostileBoxes::uniform(double from, double to) {
  return from + (to - from) * static_cast<double>(bits_() >> 11) * 0x1p-53;
}

float HostileBoxes::signed_power_of_ten(double from, double to) {
  return finite(std::pow(10.0, uniform(from, to)) * (chance(0.5) ? 1 : -1));
}

float HostileBoxes::any_finite() {
  for (;;) {
    const float x = numeric::from_bits(static_cast<std::uint32_t>(bits_()));
    if (std::isfinite(x)) return x;
  }
}

float HostileBoxes::direction_component() {
  switch (bits_() % 12) {
    case 0:
      return 0.0f;
    case 1:
      return -0.0f;
    case 2:
      return numeric::from_bits(static_cast<std::uint32_t>(bits_() & 0x807fffffu));  // subnormal or zero
    case 3:
      return signed_power_of_ten(-38, -8);
    case 4:
      return signed_power_of_ten(-3, 3);
    case 5:
      return chance(0.5) ? 1.0f : -1.0f;
    case 6:
      return chance(0.2) ? any_finite() : signed_power_of_ten(8, 38);
    default:
      return static_cast<float>(uniform(-1, 1));
  }
}

void HostileBoxes::place_box(Box4& boxes, int lane, double size, double offset) {
  if (chance(0.08)) {
    for (int axis = 0; axis < 3; ++axis) boxes.lo[axis][lane] = kInfinity, boxes.hi[axis][lane] = -kInfinity;
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    float a = finite(size * (uniform(-1, 1) + offset)), b = finite(size * (uniform(-1, 1) + offset));
    if (chance(0.02)) a = any_finite();
    if (chance(0.02)) b = any_finite();
    if (chance(0.1)) b = a;
    if (chance(0.1)) b = numeric::next_up(a);
    if (chance(0.05)) a = chance(0.5) ? 0.0f : -0.0f;
    boxes.lo[axis][lane] = std::min(a, b);
    boxes.hi[axis][lane] = std::max(a, b);
    if (std::isinf(boxes.hi[axis][lane])) boxes.hi[axis][lane] = std::numeric_limits<float>::max();
  }
}

BoxCase HostileBoxes::next() {
  BoxCase result;
  const double size = chance(0.6) ? 1.0 : std::pow(10.0, uniform(-44, 38));
  const double offset = chance(0.5) ? 0.0 : std::pow(10.0, uniform(0, 12)) * (chance(0.5) ? 1 : -1);
  for (int lane = 0; lane < kLanes; ++lane) place_box(result.boxes, lane, size, offset);
  Ray& ray = result.ray;
  const bool aimed = chance(0.4);
  for (int axis = 0; axis < 3; ++axis) {
    const float face = chance(0.5) ? result.boxes.lo[axis][0] : result.boxes.hi[axis][1];
    const bool on_face = std::isfinite(face) && chance(0.3);
    ray.origin[axis] = on_face ? face : finite(size * (uniform(-3, 3) + (chance(0.5) ? offset : 0.0)));
    ray.direction[axis] = direction_component();
    // Through a corner, as nearly as binary32 can say it.
    const float corner = chance(0.5) ? result.boxes.lo[axis][2] : result.boxes.hi[axis][2];
    if (aimed && std::isfinite(corner)) ray.direction[axis] = finite(static_cast<double>(corner) - ray.origin[axis]);
  }
  if (ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0) ray.direction.y = 1;
  ray.tmin = chance(0.7) ? 0.0f : chance(0.2) ? -0.0f : signed_power_of_ten(-10, 3);
  ray.tmax = chance(0.5) ? kInfinity : std::max(ray.tmin, signed_power_of_ten(-5, 12));
  result.tmax = chance(0.7) ? ray.tmax : std::min(ray.tmax, signed_power_of_ten(-5, 8));
  return result;
}

std::string show(const BoxCase& box_case, int lane) {
  std::ostringstream text;
  const auto add = [&](const char* name, float x) {
    text << name << " 0x" << std::hex << numeric::bits(x) << " (" << std::dec << x << ") ";
  };
  for (int axis = 0; axis < 3; ++axis) {
    text << "\naxis " << axis << ": ";
    add("o", box_case.ray.origin[axis]);
    add("d", box_case.ray.direction[axis]);
    add("lo", box_case.boxes.lo[axis][lane]);
    add("hi", box_case.boxes.hi[axis][lane]);
  }
  add("\ntmin", box_case.ray.tmin);
  add("tmax", box_case.tmax);
  return text.str();
}

}  // namespace ctu::intersect
