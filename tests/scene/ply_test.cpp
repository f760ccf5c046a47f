#include <cmath>
#include <limits>

#include "model/base/error.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using PlyTest = SceneFiles;

constexpr const char* kQuadBody = "0 0 0\n1 0 0\n1 1 0.1\n0 1 0\n4 0 1 2 3\n";

std::string header(const std::string& format, const std::string& vertices = "4", const std::string& faces = "1",
                   const std::string& real = "float") {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " + vertices + "\nproperty " + real +
         " x\nproperty " + real + " y\nproperty " + real + " z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

template <class Real>
std::string binary_quad(bool big_endian) {
  Bytes bytes(big_endian);
  for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.1f, 0.f, 1.f, 0.f}) bytes.add(static_cast<Real>(v));
  bytes.add(std::uint8_t{4});
  for (const std::int32_t i : {0, 1, 2, 3}) bytes.add(i);
  return bytes.text();
}

TEST_F(PlyTest, a_polygon_becomes_a_fan_of_triangles) {
  const Scene scene = load(write("quad.ply", header("ascii") + kQuadBody));
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(scene.mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(scene.mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_EQ(scene.mesh.vertices[2], (Vec3{1, 1, 0.1f}));
  EXPECT_EQ(scene.name, "quad");
  EXPECT_EQ(scene.report.format, "ply");
  EXPECT_EQ(scene.lower, (Vec3{0, 0, 0}));
  EXPECT_EQ(scene.upper, (Vec3{1, 1, 0.1f}));
}

TEST_F(PlyTest, every_encoding_of_a_mesh_gives_the_same_bits) {
  const Hash128 expected = content_hash(load(write("a.ply", header("ascii") + kQuadBody)).mesh);
  const std::string cases[] = {header("binary_little_endian") + binary_quad<float>(false),
                               header("binary_big_endian") + binary_quad<float>(true),
                               header("binary_little_endian", "4", "1", "double") + binary_quad<double>(false),
                               header("binary_big_endian", "4", "1", "double") + binary_quad<double>(true)};
  for (const std::string& bytes : cases) {
    SCOPED_TRACE(bytes.substr(0, 40));
    EXPECT_EQ(content_hash(load(write("b.ply", bytes)).mesh), expected);
  }
}

TEST_F(PlyTest, ascii_coordinates_are_rounded_to_the_nearest_binary32) {
  // Decimal values on and beside the midpoint of 1 and its successor 1 + 2^-23.
  const std::string body =
      "1.000000059604644775390625 1.00000005960464477539062501 1.0000000596046447753906249\n"
      "1e-50 -1e-46 +3.5\n0 1 0\n3 0 1 2\n";
  const Scene scene = load(write("round.ply", header("ascii", "3") + body));
  const float next = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(scene.mesh.vertices[0], (Vec3{1, next, 1}));
  EXPECT_EQ(scene.mesh.vertices[1], (Vec3{0, 0, 3.5f}));
  EXPECT_TRUE(std::signbit(scene.mesh.vertices[1].y));
}

TEST_F(PlyTest, other_properties_and_elements_are_passed_over) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\nobj_info test\r\nelement camera 1\r\nproperty float fov\r\nelement vertex 3\r\n"
      "property double nx\r\nproperty float z\r\nproperty list uchar float weights\r\nproperty int y\r\nproperty float "
      "x\r\n"
      "element face 1\r\nproperty uchar flag\r\nproperty list ushort short vertex_index\r\nend_header\r\n"
      "45\r\n9 3 2 0.5 0.5 2 1\r\n9 3 0 2 5\r\n9 6 1 7 2 1\r\n0 3 0 1 2\r\n";
  const Scene scene = load(write("odd.ply", text));
  EXPECT_EQ(corners(scene.mesh, 0), (std::array<Vec3, 3>{Vec3{1, 2, 3}, Vec3{5, 2, 3}, Vec3{1, 2, 6}}));
}

TEST_F(PlyTest, a_face_that_names_no_vertex_is_an_error_with_its_number) {
  for (const char* face : {"3 0 1 4\n", "3 -1 0 1\n"})
    expect_error(write("bad.ply", header("ascii") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + face), ":15 (face 0)",
                 "but there are 4");
}

TEST_F(PlyTest, a_file_cut_off_anywhere_is_an_error) {
  for (const std::string& whole :
       {header("binary_little_endian") + binary_quad<float>(false), header("ascii") + kQuadBody})
    for (std::size_t bytes = 0; bytes + 2 < whole.size(); ++bytes) {
      SCOPED_TRACE(bytes);
      EXPECT_THROW(load(write("cut.ply", whole.substr(0, bytes))), Error);
    }
}

TEST_F(PlyTest, counts_beyond_the_file_are_refused_before_memory_is_asked_for) {
  for (const char* count : {"4000000000", "9223372036854775807", "123456789"}) {
    expect_error(write("v.ply", header("ascii", count) + kQuadBody), "element vertex", "the header states");
    expect_error(write("f.ply", header("binary_little_endian", "4", count) + binary_quad<float>(false)), "element face",
                 "the header states");
  }
  expect_error(write("n.ply", header("ascii", "-1") + kQuadBody), ":4", "negative");
  expect_error(write("h.ply", header("ascii", "99999999999999999999") + kQuadBody), ":4", "not an integer");
  const std::string text =
      "ply\nformat binary_little_endian 1.0\nelement junk 1\nproperty list uint double d\nend_header\n";
  Bytes junk;
  junk.add(text).add(std::uint32_t{0xFFFFFFFF}).add(0.0);
  expect_error(write("l.ply", junk.text()), "byte", "items of a list");
}

TEST_F(PlyTest, a_coordinate_that_is_not_finite_is_an_error) {
  for (const char* number : {"nan", "inf", "-inf", "1e39", "x", "1.5.2", "0x10"})
    expect_error(write("nan.ply", header("ascii") + "0 0 0\n1 0 " + number + "\n1 1 0\n0 1 0\n4 0 1 2 3\n"), ":12",
                 "not a finite");
  Bytes bytes;
  bytes.add(header("binary_little_endian", "3"));
  for (int i = 0; i < 8; ++i) bytes.add(0.0f);
  bytes.add(std::numeric_limits<float>::quiet_NaN()).add(std::uint8_t{3}).add(0).add(1).add(2);
  expect_error(write("nan.ply", bytes.text()), "(vertex 2)", "NaN");
}

TEST_F(PlyTest, a_file_without_faces_is_an_error) {
  expect_error(write("empty.ply", header("ascii", "4", "0") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"), "empty.ply",
               "no triangles");
  expect_error(write("points.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
                     "z\nend_header\n0 0 0\n"),
               "points.ply", "no elements 'vertex' and 'face'");
  expect_error(write("zero.ply", ""), ":1", "the file ends");
  expect_error(write("other.ply", "solid cube\n"), ":1", "does not start with 'ply'");
}

TEST_F(PlyTest, triangles_without_area_are_kept_and_counted) {
  const std::string body = "0 0 0\n1 1 1\n2 2 2\n0 1 0\n3 0 1 2\n3 0 0 3\n3 0 1 3\n";
  const Scene scene = load(write("flat.ply", header("ascii", "4", "3") + body));
  EXPECT_EQ(scene.mesh.triangles.size(), 3u);
  EXPECT_EQ(scene.report.zero_area_triangles, 2u);
}

TEST_F(PlyTest, bytes_behind_the_last_element_and_short_faces_are_warned_of) {
  const Scene scene =
      load(write("tail.ply", header("ascii", "4", "3") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1\n1 0\n3 0 1 2\nmore\n"));
  ASSERT_EQ(scene.report.warnings.size(), 2u);
  EXPECT_NE(scene.report.warnings[0].find("fewer than three corners was skipped (2 times)"), std::string::npos);
  EXPECT_NE(scene.report.warnings[1].find("ignored"), std::string::npos);
}

}  // namespace
}  // namespace ctu::scene::test
