#include "sim/paper/raydist_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/scene/vector64.h"

namespace ctu::sim::paper {
namespace {

using influence::AreaKind;
using scene::Vector64;

constexpr double kFarAway = 1000, kOutside = 0.625;  // diagonals

int upward_axis(const Vec3& up) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(up[a]) > std::fabs(up[axis])) axis = a;
  return axis;
}

/// Unit vectors towards the light, in the order of kOrientations.
std::array<Vector64, 4> directions(const Vec3& up) {
  const int axis = upward_axis(up);
  const double sign = up[axis] < 0 ? -1 : 1, tan15 = 2 - std::sqrt(3.0);
  const auto towards = [&](double first, double second) {
    double v[3];
    v[axis] = sign;
    v[(axis + 1) % 3] = first;
    v[(axis + 2) % 3] = second;
    return scene::normalized({v[0], v[1], v[2]}, {0, 0, 1});
  };
  return {towards(0, 0), towards(tan15, 0), towards(1, 0), towards(1.1, 0.7)};
}

/// How far the bounds are from their middle in a direction.
double way_out(const Vector64& half, const Vector64& direction) {
  double way = std::numeric_limits<double>::infinity();
  for (const auto& [h, d] : {std::pair{half.x, direction.x}, {half.y, direction.y}, {half.z, direction.z}})
    if (d != 0) way = std::min(way, h / std::fabs(d));
  return way;
}

}  // namespace

std::string TestLight::name() const { return std::string(to_string(kind)) + ", " + kOrientations[orientation]; }

std::vector<TestLight> test_lights(const scene::Scene& scene) {
  const Vector64 low(scene.lower), high(scene.upper);
  const Vector64 middle = (low + high) * 0.5, half = (high - low) * 0.5;
  const double diagonal = length(high - low);
  bool in_room = true;
  for (int axis = 0; axis < 3; ++axis)
    in_room = in_room && scene.camera.eye[axis] >= scene.lower[axis] && scene.camera.eye[axis] <= scene.upper[axis];
  std::vector<TestLight> lights;
  for (const AreaKind kind : {AreaKind::Plane, AreaKind::Point}) {
    const auto towards = directions(scene.camera.up);
    for (std::size_t i = 0; i < towards.size(); ++i) {
      const double away = kind == AreaKind::Plane ? kFarAway * diagonal
                          : in_room               ? 0.9 * way_out(half, towards[i])
                                                  : kOutside * diagonal;
      lights.push_back({kind, i, (middle + towards[i] * away).rounded()});
    }
  }
  return lights;
}

}  // namespace ctu::sim::paper
