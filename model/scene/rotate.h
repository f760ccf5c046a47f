// A scene turned about the axes, its picture unchanged: how well boxes along the axes fit depends on where they point.
#pragma once

#include "model/numeric/vec3.h"
#include "model/scene/scene.h"

namespace ctu::scene {

/// Turns vertices, spheres and camera about the x, then the y, then the z axis, by degrees; each coordinate is rounded
/// to binary32 once. Whole multiples of 90 degrees are exact. Bounds follow.
void rotate(Scene& scene, const Vec3& degrees);

}  // namespace ctu::scene
