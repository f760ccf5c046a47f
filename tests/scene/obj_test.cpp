#include <cmath>

#include "model/base/error.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using ObjTest = SceneFiles;

constexpr const char* kVertices = "# four corners\nv 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\n";

TEST_F(ObjTest, faces_of_every_spelling_name_the_same_vertices) {
  const std::string cases[] = {"f 1 2 3\nf 1 3 4\n", "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\n",
                               "f -4 -3 -2\nf -4 -2 -1\n", "usemtl none\ng a\nf 1 2 3\ng b\ns 1\nf 1 3 4 # comment\n"};
  const Hash128 expected = content_hash(load(write("a.obj", kVertices + cases[0])).mesh);
  for (const std::string& faces : cases) {
    SCOPED_TRACE(faces);
    const Scene scene = load(write("b.obj", kVertices + faces));
    EXPECT_EQ(scene.mesh.triangles.size(), 2u);
    EXPECT_EQ(content_hash(scene.mesh), expected);
  }
}

TEST_F(ObjTest, polygons_become_triangles_over_all_line_ends) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const Scene scene = load(
        write("quad.obj", "v 0 0 0" + end + "v 1 0 0" + end + "v 1 1 0.1" + end + "v 0 1 0" + end + "f 1 2 3 4" + end));
    EXPECT_EQ(scene.mesh.triangles.size(), 2u);
    EXPECT_EQ(scene.mesh.vertices[2], (Vec3{1, 1, 0.1f}));
    EXPECT_EQ(scene.report.format, "obj");
  }
}

TEST_F(ObjTest, an_index_out_of_range_is_an_error_with_its_line) {
  expect_error(write("a.obj", kVertices + std::string("f 1 2 3\nf 1 2 5\n")), "a.obj:7",
               "names vertex 5, but there are 4");
  expect_error(write("b.obj", kVertices + std::string("f 1 2 -5\n")), "b.obj:6", "names vertex -5");
  expect_error(write("c.obj", kVertices + std::string("f 0 1 2\n")), "c.obj:6", "names vertex 0");
  expect_error(write("d.obj", kVertices + std::string("f 1 2 99999999999999999999\n")), "d.obj:6",
               "not a vertex number");
}

TEST_F(ObjTest, a_line_that_is_cut_off_or_no_number_is_an_error_with_its_line) {
  expect_error(write("a.obj", "v 0 0\n"), "a.obj:1", "coordinate");
  for (const char* number : {"nan", "inf", "1e40", "one"})
    expect_error(write("b.obj", "v 0 0 0\nv 1 " + std::string(number) + " 0\n"), "b.obj:2", number);
  expect_error(write("c.obj", kVertices + std::string("f 1 2")), "c.obj:6", "a face with 2 corners");
  expect_error(write("d.obj", kVertices + std::string("f 1 2 \\\n3\n")), "d.obj:6", "continues");
}

TEST_F(ObjTest, a_file_without_faces_is_an_error) {
  expect_error(write("points.obj", kVertices), "points.obj", "no triangles");
  expect_error(write("empty.obj", ""), "empty.obj", "no triangles");
}

TEST_F(ObjTest, lines_and_points_are_warned_of) {
  const Scene scene = load(write("lines.obj", kVertices + std::string("f 1 2 3\nl 1 2\n")));
  EXPECT_EQ(scene.mesh.triangles.size(), 1u);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
}

TEST_F(ObjTest, tags_of_subdivision_surfaces_are_not_kept) {
  // The library would keep 300 kB for each of these lines.
  std::string tags;
  for (int i = 0; i < 20000; ++i) tags += " \tt corner 8192/8192/8192\n";
  const Scene scene = load(write("tags.obj", kVertices + tags + "f 1 2 3\n"));
  EXPECT_EQ(scene.mesh.triangles.size(), 1u);
}

TEST_F(ObjTest, a_face_of_very_many_corners_is_refused) {
  const auto polygon = [&](int corners) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      const double angle = 6.283185307179586 * i / corners;
      text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
      face += std::to_string(i + 1).insert(0, 1, ' ');
    }
    return write("polygon.obj", text + face + "\n");
  };
  EXPECT_EQ(load(polygon(1024)).mesh.triangles.size(), 1022u);
  expect_error(polygon(1025), "polygon.obj:1026", "a face with 1025 corners; 1024 are possible");
}

TEST_F(ObjTest, a_polygon_that_is_not_cut_whole_is_warned_of) {
  const Scene scene = load(write("cross.obj", "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4 5\nf 1 2 3\n"));
  if (scene.mesh.triangles.size() < 4) {
    EXPECT_FALSE(scene.report.warnings.empty());
  }
}

}  // namespace
}  // namespace ctu::scene::test
