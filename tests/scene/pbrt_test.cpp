#include <fmt/core.h>

#include "model/base/error.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using PbrtTest = SceneFiles;

// One triangle (1,0,0) (0,1,0) (0,0,1): each corner shows one axis.
constexpr const char* kTriangle =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [1 0 0 0 1 0 0 0 1]\n";

std::array<Vec3, 3> first(const Scene& scene) { return corners(scene.mesh, 0); }

TEST_F(PbrtTest, transforms_compose_so_that_the_last_one_acts_first) {
  const Scene scene =
      load(write("a.pbrt", std::string("WorldBegin\nTranslate 10 0 0\nRotate 90 0 0 1\nScale 2 3 4\n") + kTriangle));
  // Scale, then a quarter turn (x to y, y to -x), then the move.
  EXPECT_EQ(first(scene), (std::array<Vec3, 3>{Vec3{10, 2, 0}, Vec3{7, 0, 0}, Vec3{10, 0, 4}}));
}

TEST_F(PbrtTest, a_matrix_is_given_column_by_column_and_replaces_or_multiplies) {
  const std::string matrix = "[0 1 0 0  0 0 1 0  1 0 0 0  5 6 7 1]\n";  // x to y, y to z, z to x, then + (5, 6, 7)
  const Scene replaced = load(write("a.pbrt", "WorldBegin Scale 9 9 9 Transform " + matrix + kTriangle));
  EXPECT_EQ(first(replaced), (std::array<Vec3, 3>{Vec3{5, 7, 7}, Vec3{5, 6, 8}, Vec3{6, 6, 7}}));
  const Scene multiplied = load(write("b.pbrt", "WorldBegin Scale 2 2 2 ConcatTransform " + matrix + kTriangle));
  EXPECT_EQ(first(multiplied), (std::array<Vec3, 3>{Vec3{10, 14, 14}, Vec3{10, 12, 16}, Vec3{12, 12, 14}}));
}

TEST_F(PbrtTest, many_small_transforms_round_only_once) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 1000; ++i) text += "Translate 0.1 0 0\n";
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += 0.1;
  EXPECT_EQ(first(load(write("a.pbrt", text + kTriangle)))[1].x, static_cast<float>(sum));
}

TEST_F(PbrtTest, blocks_restore_the_matrix_even_when_they_are_closed_crosswise) {
  const Scene scene =
      load(write("a.pbrt", std::string("WorldBegin\nAttributeBegin\nTranslate 1 0 0\nTransformBegin\nTranslate 2 0 0\n"
                                       "AttributeEnd\n") +
                               kTriangle + "TransformEnd\n" + kTriangle));
  EXPECT_EQ(corners(scene.mesh, 0)[1], (Vec3{1, 1, 0}));
  EXPECT_EQ(corners(scene.mesh, 1)[1], (Vec3{0, 1, 0}));
  expect_error(write("b.pbrt", "WorldBegin\nAttributeEnd\n"), "b.pbrt:2", "not begun");
}

TEST_F(PbrtTest, an_instance_places_the_object_as_it_stood_when_defined) {
  const Scene scene =
      load(write("a.pbrt", std::string("WorldBegin\nAttributeBegin\nScale 2 2 2\nObjectBegin \"leaf\"\n"
                                       "AttributeBegin\nTranslate 0 0 1\n") +
                               kTriangle +
                               "AttributeEnd\nAttributeEnd\nObjectEnd\n"  // crossed, as San Miguel has it
                               "AttributeBegin Translate 100 0 0 ObjectInstance \"leaf\" AttributeEnd\n"
                               "AttributeBegin Translate 200 0 0 ObjectInstance \"leaf\" AttributeEnd\n"));
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(scene.report.instances, 2u);
  EXPECT_EQ(corners(scene.mesh, 0), (std::array<Vec3, 3>{Vec3{102, 0, 2}, Vec3{100, 2, 2}, Vec3{100, 0, 4}}));
  EXPECT_EQ(corners(scene.mesh, 1)[0], (Vec3{202, 0, 2}));
}

TEST_F(PbrtTest, an_object_that_is_never_placed_is_not_there) {
  expect_error(write("a.pbrt", std::string("WorldBegin ObjectBegin \"leaf\"\n") + kTriangle + "ObjectEnd\n"), "a.pbrt",
               "no triangles");
  expect_error(write("b.pbrt", "WorldBegin\nObjectInstance \"leaf\"\n"), "b.pbrt:2", "no object 'leaf'");
}

TEST_F(PbrtTest, files_are_named_from_the_scenes_folder_also_inside_included_ones) {
  write("geometry/tri.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 0 0 0 1 0 0 0 1\n3 0 1 2\n");
  const std::string part =
      write("geometry/part.pbrt", "Translate 1 1 1\nShape \"plymesh\" \"string filename\" [\"geometry/tri.ply\"]\n");
  const Scene scene =
      load(write("a.pbrt", "WorldBegin\nInclude \"geometry/part.pbrt\"\nWorldEnd\nnothing of this is read"));
  EXPECT_EQ(first(scene), (std::array<Vec3, 3>{Vec3{2, 1, 1}, Vec3{1, 2, 1}, Vec3{1, 1, 2}}));
  EXPECT_EQ(scene.report.format, "pbrt");
  EXPECT_EQ(content_hash(load(part).mesh), content_hash(scene.mesh)) << "a part loads alone, from the folder above";
}

TEST_F(PbrtTest, a_file_that_is_not_there_is_an_error_unless_it_is_listed_as_missing) {
  const std::string text =
      std::string("WorldBegin\n") + kTriangle + "Shape \"plymesh\" \"string filename\" \"lost.ply\"\n";
  expect_error(write("a.pbrt", text), "a.pbrt:3", "names 'lost.ply'");
  write("MISSING.txt", "other.ply\nlost.ply\n");
  const Scene scene = load(path("a.pbrt"));
  EXPECT_EQ(scene.mesh.triangles.size(), 1u);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_NE(scene.report.warnings[0].find("lost.ply"), std::string::npos);
}

TEST_F(PbrtTest, meshes_of_objects_and_includes_can_be_left_out) {
  write("leaf.ply", "not read");
  write("more.pbrt", "not read");
  LoadOptions options;
  options.without = {"leaf.ply", "more.pbrt"};
  const Scene scene =
      load(write("a.pbrt", std::string("WorldBegin ObjectBegin \"o\" Shape \"plymesh\" \"string filename\" "
                                       "\"leaf.ply\" ObjectEnd ObjectInstance \"o\"\n"
                                       "Include \"more.pbrt\"\n") +
                               kTriangle),
           options);
  EXPECT_EQ(scene.mesh.triangles.size(), 1u);
  EXPECT_EQ(scene.report.warnings.size(), 2u);
}

TEST_F(PbrtTest, warnings_of_the_parts_of_an_object_are_kept) {
  write(
      "tail.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n1 0 0 0 1 0 0 0 1\n3 0 1 2\nmore\n");
  const Scene scene = load(write("a.pbrt",
                                 "WorldBegin ObjectBegin \"o\" Shape \"plymesh\" \"string filename\" \"tail.ply\" "
                                 "ObjectEnd ObjectInstance \"o\" ObjectInstance \"o\"\n"));
  EXPECT_EQ(scene.mesh.triangles.size(), 2u);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_NE(scene.report.warnings[0].find("tail.ply"), std::string::npos);
}

TEST_F(PbrtTest, includes_in_a_circle_are_an_error) {
  write("b.pbrt", "Include \"c.pbrt\"\n");
  write("c.pbrt", "Include \"./b.pbrt\"\n");
  expect_error(write("a.pbrt", "WorldBegin\nInclude \"b.pbrt\"\n"), "b.pbrt", "includes itself");
  for (int i = 0; i < 40; ++i) write(fmt::format("d{}.pbrt", i), fmt::format("Include \"d{}.pbrt\"\n", i + 1));
  expect_error(path("d0.pbrt"), "d32.pbrt", "more than 32 deep");
}

TEST_F(PbrtTest, everything_that_is_no_geometry_is_passed_over) {
  const Scene scene = load(write("a.pbrt", std::string(R"(# a comment with "quotes [ and words
Integrator "path" "integer maxdepth" [ 17 ]
Sampler "sobol" "integer pixelsamples" 64
Film "image" "integer xresolution" [ 4 ] "string filename" [ "k.png" ]
WorldBegin
Texture "t" "spectrum" "imagemap" "string filename" [ "t.tga" ] "bool trilinear" true
MakeNamedMaterial "m" "string type" [ "uber" ] "rgb Kd" [ .5 .5 .5 ]  # tail
NamedMaterial "m"
AreaLightSource "diffuse" "blackbody L" [2700 15]
LightSource "infinite" "rgb L" [1 1 1]
ReverseOrientation
)") + kTriangle));
  EXPECT_EQ(first(scene)[0], (Vec3{1, 0, 0}));
  EXPECT_TRUE(scene.report.warnings.empty());
}

TEST_F(PbrtTest, a_misspelt_statement_is_an_error_that_names_the_nearest) {
  try {
    load(write("a.pbrt", std::string("WorldBegin\nTrasnlate 1 2 3\n") + kTriangle));
    FAIL() << "loaded";
  } catch (const Error& error) {
    EXPECT_NE(error.where().find("a.pbrt:2"), std::string::npos);
    EXPECT_NE(error.remedy().find("Translate"), std::string::npos);
  }
}

TEST_F(PbrtTest, spheres_are_moved_by_what_keeps_them_round) {
  const Scene scene = load(write("a.pbrt",
                                 "WorldBegin\nShape \"sphere\"\nTranslate 1 2 3\nRotate 30 1 1 0\nScale 2 -2 2\n"
                                 "Shape \"sphere\" \"float radius\" [3]\nObjectBegin \"o\"\nTranslate 1 0 0\n"
                                 "Shape \"sphere\" \"float radius\" 1 \"float zmin\" -1\nObjectEnd\n"
                                 "AttributeBegin\nScale 0.5 0.5 0.5\nObjectInstance \"o\"\nAttributeEnd\n"));
  ASSERT_EQ(scene.mesh.spheres.size(), 3u);
  EXPECT_EQ(scene.mesh.spheres[0], (Sphere{{0, 0, 0}, 1}));
  EXPECT_EQ(scene.mesh.spheres[1].centre, (Vec3{1, 2, 3}));
  EXPECT_FLOAT_EQ(scene.mesh.spheres[1].radius, 6);
  EXPECT_FLOAT_EQ(scene.mesh.spheres[2].radius, 2);  // the object's scale of 2 and the instance's, 2 * 0.5
  EXPECT_TRUE(scene.mesh.triangles.empty());
}

TEST_F(PbrtTest, spheres_that_are_cut_or_not_round_are_errors) {
  expect_error(write("a.pbrt", "WorldBegin\nScale 1 1 1.001\nShape \"sphere\"\n"), "a.pbrt:3", "ellipsoid");
  expect_error(write("b.pbrt", "WorldBegin\nTransform [1 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1]\nShape \"sphere\"\n"),
               "b.pbrt:3", "ellipsoid");
  expect_error(write("c.pbrt", "WorldBegin\nShape \"sphere\" \"float phimax\" [180]\n"), "c.pbrt:2",
               "part of a sphere");
  expect_error(write("d.pbrt", "WorldBegin\nShape \"sphere\" \"float zmin\" [0]\n"), "d.pbrt:2", "part of a sphere");
  expect_error(write("e.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" [1 2]\n"), "e.pbrt:2",
               "one finite number");
}

TEST_F(PbrtTest, other_shapes_are_refused_by_name) {
  expect_error(write("d.pbrt", "WorldBegin\nShape \"disk\"\n"), "d.pbrt:2", "'disk' is not read");
}

TEST_F(PbrtTest, wrong_numbers_are_errors_with_their_line) {
  const auto shape = [&](const std::string& rest) {
    return write("a.pbrt", "WorldBegin\nShape \"trianglemesh\"\n" + rest + "\n");
  };
  expect_error(shape("\"integer indices\" [0 1 3] \"point P\" [1 0 0 0 1 0 0 0 1]"), "a.pbrt:3",
               "index '3' names none of the 3 points");
  expect_error(shape("\"integer indices\" [0 1 -1] \"point P\" [1 0 0 0 1 0 0 0 1]"), "a.pbrt:3", "index '-1'");
  expect_error(shape("\"integer indices\" [0 1 1.5] \"point P\" [1 0 0 0 1 0 0 0 1]"), "a.pbrt:3", "index '1.5'");
  expect_error(shape("\"integer indices\" [0 1] \"point P\" [1 0 0 0 1 0 0 0 1]"), "a.pbrt:3",
               "no whole number of triangles");
  expect_error(shape("\"integer indices\" [0 1 2] \"point P\" [1 0 0 0 1 0 0 0]"), "a.pbrt:3",
               "no whole number of points");
  expect_error(shape("\"integer indices\" [0 1 2] \"point P\" [1 0 0 0 nan 0 0 0 1]"), "a.pbrt:3", "'nan'");
  expect_error(shape("\"integer indices\" [0 1 2]"), "a.pbrt:2", "without points");
  expect_error(shape("\"point P\" [1 0 0 0 1 0"), "a.pbrt:4", "the file ends");
  expect_error(write("b.pbrt", "WorldBegin\nScale 1 2\nShape \"sphere\"\n"), "b.pbrt:2",
               "'Shape' is not a finite number");
  expect_error(write("c.pbrt", "WorldBegin\nTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0]\n"), "c.pbrt:2", "']' is not");
  expect_error(write("d.pbrt", "WorldBegin\nTransform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]\n"), "d.pbrt:2", "projection");
  expect_error(write("e.pbrt", "WorldBegin\nRotate 10 0 0 0\n"), "e.pbrt:2", "zero axis");
  expect_error(write("f.pbrt", "WorldBegin\nShape \"plymesh\n"), "f.pbrt:2", "closing quote");
  expect_error(write("g.pbrt", "WorldBegin\n[ 1 2 ]\n"), "g.pbrt:2", "where a statement should begin");
  expect_error(write("h.pbrt", std::string("WorldBegin\nScale 1e30 1e30 1e30\nScale 1e30 1 1\n") + kTriangle),
               "h.pbrt: vertex 0", "not finite");
}

TEST_F(PbrtTest, the_camera_is_where_look_at_or_a_matrix_puts_it) {
  const Camera looked =
      load(write("a.pbrt",
                 std::string("LookAt 1 2 3  1 2 -7  0 5 0\nCamera \"perspective\" \"float fov\" [50]\nWorldBegin\n") +
                     kTriangle))
          .camera;
  EXPECT_TRUE(looked.from_file);
  EXPECT_EQ(looked.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(looked.target, (Vec3{1, 2, 2}));
  EXPECT_EQ(looked.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(looked.vertical_fov_degrees, 50);
  // World to camera: moved by (0, 0, 4), so the eye is at (0, 0, -4) and looks along +z.
  const Camera moved =
      load(write("b.pbrt", std::string("Scale -1 1 1 Translate 0 0 4 Camera \"perspective\" WorldBegin\n") + kTriangle))
          .camera;
  EXPECT_EQ(moved.eye, (Vec3{0, 0, -4}));
  EXPECT_EQ(moved.target, (Vec3{0, 0, -3}));
  EXPECT_EQ(moved.vertical_fov_degrees, 90);
  const Camera placed = load(write("c.pbrt", std::string("WorldBegin\n") + kTriangle)).camera;
  EXPECT_FALSE(placed.from_file);
}

}  // namespace
}  // namespace ctu::scene::test
