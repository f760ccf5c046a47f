#include "model/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace ctu::scene {
namespace {

bool z_is_up(const std::string& format) {
  for (const char* name : {"hair", "pbrt", "nff", "luxcore", "generated"})
    if (format.find(name) != std::string::npos) return true;
  return false;
}

}  // namespace

Camera default_camera(const Scene& scene) {
  // A ball around the box fills the field of view: 45 degrees across puts the eye at radius / sin(22.5 degrees).
  constexpr double kOverSinOfHalf = 2.6131259297527530557;
  constexpr double kMargin = 1.02;
  double center[3], squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    center[axis] = 0.5 * (double{scene.lower[axis]} + scene.upper[axis]);
    const double half = 0.5 * (double{scene.upper[axis]} - scene.lower[axis]);
    squared += half * half;
  }
  // A scene that is one point still needs an eye that binary32 can tell from it.
  const double far = std::max({std::fabs(center[0]), std::fabs(center[1]), std::fabs(center[2])});
  const double radius = std::max({std::sqrt(squared), 1e-4 * far, 1e-30});
  const double distance = radius * kOverSinOfHalf * kMargin;
  const bool z_up = z_is_up(scene.report.format);
  // No component is zero and none equals another, so that no axis of the scene is seen edge-on.
  const double toward[3] = {0.64, z_up ? -0.62 : 0.45, z_up ? 0.45 : 0.62};
  const double length = std::sqrt(toward[0] * toward[0] + toward[1] * toward[1] + toward[2] * toward[2]);

  Camera camera;
  for (int axis = 0; axis < 3; ++axis) {
    camera.target[axis] = static_cast<float>(center[axis]);
    camera.eye[axis] = static_cast<float>(center[axis] + distance * toward[axis] / length);
  }
  camera.up = z_up ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  camera.vertical_fov_degrees = 45;
  camera.from_file = false;
  return camera;
}

}  // namespace ctu::scene
