// Turning a scene moves it as a rigid body, camera and all, and quarter turns are exact.
#include <gtest/gtest.h>

#include <cmath>

#include "model/scene/load.h"
#include "model/scene/rotate.h"

namespace ctu::scene {
namespace {

double distance(const Vec3& a, const Vec3& b) {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) squared += std::pow(double{a[axis]} - b[axis], 2);
  return std::sqrt(squared);
}

TEST(Rotate, quarter_turns_are_exact_and_go_from_x_to_y_to_z) {
  const Scene before = load("gen:tilted-quads?quads=50");
  Scene z = before, y = before, x = before;
  rotate(z, {0, 0, 90});
  rotate(y, {0, -270, 0});
  rotate(x, {450, 0, 0});
  for (std::size_t i = 0; i < before.mesh.vertices.size(); ++i) {
    const Vec3& v = before.mesh.vertices[i];
    EXPECT_EQ(z.mesh.vertices[i], (Vec3{-v[1], v[0], v[2]}));
    EXPECT_EQ(y.mesh.vertices[i], (Vec3{v[2], v[1], -v[0]}));
    EXPECT_EQ(x.mesh.vertices[i], (Vec3{v[0], -v[2], v[1]}));
  }
  EXPECT_EQ(z.lower, (Vec3{-before.upper[1], before.lower[0], before.lower[2]}));
  EXPECT_EQ(z.upper, (Vec3{-before.lower[1], before.upper[0], before.upper[2]}));
}

TEST(Rotate, the_camera_sees_every_vertex_from_as_far_as_before) {
  const Scene before = load("gen:hair-ball?strands=20");
  Scene after = before;
  rotate(after, {20, -35, 77});
  EXPECT_NEAR(distance(after.camera.eye, after.camera.target), distance(before.camera.eye, before.camera.target), 1e-5);
  for (std::size_t i = 0; i < before.mesh.vertices.size(); ++i)
    EXPECT_NEAR(distance(after.camera.eye, after.mesh.vertices[i]),
                distance(before.camera.eye, before.mesh.vertices[i]), 1e-5)
        << i;
}

}  // namespace
}  // namespace ctu::scene
