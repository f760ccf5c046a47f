#include "model/scene/rotate.h"

#include "model/scene/turn.h"

namespace ctu::scene {
namespace {

struct Rotation {
  Turn about[3];

  Vec3 operator()(const Vec3& v) const {
    double at[3] = {v[0], v[1], v[2]};
    for (int axis = 0; axis < 3; ++axis) {
      double &a = at[(axis + 1) % 3], &b = at[(axis + 2) % 3];
      const double turned = about[axis].cosine * a - about[axis].sine * b;
      b = about[axis].sine * a + about[axis].cosine * b;
      a = turned;
    }
    return {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
  }
};

}  // namespace

void rotate(Scene& scene, const Vec3& degrees) {
  const auto about = [&](int axis) { return turn(static_cast<double>(degrees[axis]) / 360); };
  const Rotation rotation{{about(0), about(1), about(2)}};
  for (Vec3& vertex : scene.mesh.vertices) vertex = rotation(vertex);
  for (Sphere& sphere : scene.mesh.spheres) sphere.centre = rotation(sphere.centre);
  scene.camera.eye = rotation(scene.camera.eye);
  scene.camera.target = rotation(scene.camera.target);
  scene.camera.up = rotation(scene.camera.up);
  if (scene.mesh.primitives() != 0) measure_bounds(scene);
}

}  // namespace ctu::scene
