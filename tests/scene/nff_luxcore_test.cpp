#include "model/base/error.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using NffTest = SceneFiles;
using LuxcoreTest = SceneFiles;

constexpr const char* kView =
    "b 0.1 0.2 0.3\nv\nfrom 1 2 3\nat 0 0 1\nup 0 0 1\nangle 40\nhither 1\nresolution 64 64\n";

TEST_F(NffTest, polygons_and_the_view_are_read) {
  const Scene scene = load(write("a.nff", std::string(kView) + "l 1 2 3\n# a remark\nf 1 0.2 0.2 1 0 100000 0 0\n"
                                                               "p 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                                                               "pp 3\n0 0 5 0 0 1\n1 0 5 0 0 1\n0 1 5 0 0 1\n"));
  ASSERT_EQ(scene.mesh.triangles.size(), 3u);
  EXPECT_EQ(corners(scene.mesh, 1), (std::array<Vec3, 3>{Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}));
  EXPECT_EQ(corners(scene.mesh, 2), (std::array<Vec3, 3>{Vec3{0, 0, 5}, Vec3{1, 0, 5}, Vec3{0, 1, 5}}));
  EXPECT_TRUE(scene.camera.from_file);
  EXPECT_EQ(scene.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.camera.target, (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.camera.vertical_fov_degrees, 40);
}

TEST_F(NffTest, what_is_no_polygon_is_refused_by_name) {
  expect_error(write("b.nff", "c\n0 0 0 1\n0 0 1 1\n"), "b.nff:1", "cone");
  expect_error(write("c.nff", "blob 3\n"), "c.nff:1", "unknown statement 'blob'");
}

TEST_F(NffTest, spheres_come_after_the_polygons_and_grow_the_bounds) {
  const Scene scene = load(write("a.nff", std::string(kView) + "s 0 0 1 2\np 3\n0 0 0\n1 0 0\n0 1 0\ns 5 0 0 -0.5\n"));
  ASSERT_EQ(scene.mesh.triangles.size(), 1u);
  ASSERT_EQ(scene.mesh.spheres.size(), 2u);
  EXPECT_EQ(scene.mesh.spheres[0], (Sphere{{0, 0, 1}, 2}));
  EXPECT_EQ(scene.mesh.spheres[1], (Sphere{{5, 0, 0}, 0.5f}));
  EXPECT_EQ(scene.lower, (Vec3{-2, -2, -1}));
  EXPECT_EQ(scene.upper, (Vec3{5.5f, 2, 3}));
  EXPECT_EQ(load(write("b.nff", "s 0 0 1 2\n")).mesh.primitives(), 1u);
}

TEST_F(NffTest, wrong_spheres_are_errors) {
  expect_error(write("a.nff", "s 0 0 1\n"), "a.nff", "");
  expect_error(write("b.nff", "s 0 0 nan 1\n"), "b.nff:1", "'nan'");
  expect_error(write("c.nff", "s 3e38 0 0 3e38\n"), "c.nff: sphere 0", "not finite");
}

TEST_F(NffTest, wrong_polygons_are_errors_with_their_line) {
  expect_error(write("a.nff", "p 2\n0 0 0\n1 0 0\n"), "a.nff:1", "2 corners");
  expect_error(write("b.nff", "p 4000000000\n0 0 0\n"), "b.nff:1", "4000000000 corners");
  expect_error(write("c.nff", "p 3\n0 0 0\n1 0 0\n"), "c.nff", "");
  expect_error(write("d.nff", "p 3\n0 0 0\n1 nan 0\n0 1 0\n"), "d.nff:3", "'nan'");
  expect_error(write("e.nff", "p 3\n0 0 0\n1 0\np 3\n0 0 0\n"), "e.nff:4", "'p'");
  expect_error(write("f.nff", kView), "f.nff", "no triangles");
}

std::string triangle_ply(const std::string& z) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
         "1\n"
         "property list uchar int vertex_indices\nend_header\n0 0 " +
         z + "\n1 0 " + z + "\n0 1 " + z + "\n3 0 1 2\n";
}

TEST_F(LuxcoreTest, objects_are_plys_beside_the_scene) {
  write("one.ply", triangle_ply("1"));
  write("two.ply", triangle_ply("2"));
  write("MISSING.txt", "three.ply\n");
  const Scene scene =
      load(write("a.scn",
                 "scene.camera.lookat = 1 2 3 4 5 6\n#scene.camera.fieldofview = 75\n"
                 "scene.materials.m.kd = 0.5 0.5 0.5\nscene.objects.one.material = m\n"
                 "scene.objects.one.ply = scenes/room/one.ply\nscene.objects.three.ply = scenes/room/three.ply\n"
                 "scene.objects.two.ply = two.ply\n"));
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(corners(scene.mesh, 1)[0], (Vec3{0, 0, 2}));
  EXPECT_EQ(scene.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.camera.target, (Vec3{4, 5, 6}));
  EXPECT_EQ(scene.report.format, "luxcore");
  EXPECT_EQ(scene.report.warnings.size(), 1u);
}

TEST_F(LuxcoreTest, wrong_lines_and_absent_files_are_errors) {
  expect_error(write("a.scn", "\nscene.objects.x.ply = x.ply\n"), "a.scn:2", "names 'x.ply'");
  expect_error(write("b.scn", "scene.camera.lookat = 1 2 3\n"), "b.scn:1", "6 finite numbers");
  expect_error(write("c.scn", "what is this\n"), "c.scn:1", "key = value");
  expect_error(write("d.scn", "scene.objects.x.transformation = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"), "d.scn:1",
               "transform");
}

}  // namespace
}  // namespace ctu::scene::test
