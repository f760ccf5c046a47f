#include <limits>

#include "model/base/error.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using GltfTest = SceneFiles;

// One triangle (0,0,0) (1,0,0) (0,1,0), then indices 0 1 2 as u16.
std::string triangle_bytes() {
  Bytes bytes;
  for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) bytes.add(v);
  for (const std::uint16_t i : {0, 1, 2}) bytes.add(i);
  return bytes.text();
}

struct Document {
  std::string nodes = R"([{"mesh":0}])";
  std::string scene_nodes = "[0]";
  std::string count = "3", index_count = "3", index_type = "5123", index_offset = "0";
  std::string buffer = R"({"byteLength":42,"uri":"t.bin"})";
  std::string view_length = "36", extra, primitive = R"({"attributes":{"POSITION":0},"indices":1})";

  std::string json() const {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + scene_nodes + R"(}],"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":[)" + primitive +
           R"(]}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" + count +
           R"(,"type":"VEC3"},{"bufferView":1,"byteOffset":)" + index_offset + R"(,"componentType":)" + index_type +
           R"(,"count":)" + index_count + R"(,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":)" +
           view_length + R"(},{"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[)" + buffer + "]" + extra + "}";
  }
};

class OneTriangle : public GltfTest {
 protected:
  std::string file(const Document& document) const {
    write("t.bin", triangle_bytes());
    return write("t.gltf", document.json());
  }
};

TEST_F(OneTriangle, is_read_from_a_separate_buffer) {
  const Scene scene = load(file({}));
  ASSERT_EQ(scene.mesh.triangles.size(), 1u);
  EXPECT_EQ(corners(scene.mesh, 0), (std::array<Vec3, 3>{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}));
  EXPECT_EQ(scene.report.format, "gltf");
}

TEST_F(OneTriangle, is_the_same_in_a_glb) {
  Document document;
  document.buffer = R"({"byteLength":42})";
  const Scene scene = load(write("t.glb", glb(document.json(), triangle_bytes())));
  EXPECT_EQ(content_hash(scene.mesh), content_hash(load(file({})).mesh));
}

TEST_F(OneTriangle, is_placed_by_nested_scale_then_rotation_then_translation) {
  Document document;
  // Child: scale 2, a quarter turn about z, then +x 10. Parent: a matrix that moves by (0, 0, 5) and doubles z.
  document.nodes = R"([{"children":[1],"matrix":[1,0,0,0, 0,1,0,0, 0,0,2,0, 0,0,5,1]},
    {"mesh":0,"translation":[10,0,1],"rotation":[0,0,0.70710678118654752,0.70710678118654752],"scale":[2,2,2]}])";
  const Scene scene = load(file(document));
  EXPECT_EQ(corners(scene.mesh, 0), (std::array<Vec3, 3>{Vec3{10, 0, 7}, Vec3{10, 2, 7}, Vec3{8, 0, 7}}));
}

TEST_F(OneTriangle, may_stand_in_several_nodes) {
  Document document;
  document.nodes = R"([{"mesh":0},{"mesh":0,"translation":[0,0,3]}])";
  document.scene_nodes = "[0,1]";
  const Scene scene = load(file(document));
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(corners(scene.mesh, 1)[1], (Vec3{1, 0, 3}));
}

TEST_F(OneTriangle, without_indices_takes_the_vertices_in_order) {
  for (const char* mode : {"4", "5", "6"}) {
    Document document;
    document.primitive = R"({"attributes":{"POSITION":0},"mode":)" + std::string(mode) + "}";
    EXPECT_EQ(load(file(document)).mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
  }
}

TEST_F(OneTriangle, brings_the_camera_of_the_file) {
  Document document;
  document.nodes = R"([{"mesh":0},{"camera":0,"translation":[0,0,4]}])";
  document.scene_nodes = "[0,1]";
  document.extra = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1.5707963267948966,"znear":0.1}}])";
  const Camera camera = load(file(document)).camera;
  EXPECT_TRUE(camera.from_file);
  EXPECT_EQ(camera.eye, (Vec3{0, 0, 4}));
  EXPECT_EQ(camera.target, (Vec3{0, 0, 3}));
  EXPECT_FLOAT_EQ(camera.vertical_fov_degrees, 90);
}

TEST_F(OneTriangle, with_wrong_counts_or_indices_is_an_error) {
  const auto with = [](std::string Document::*member, const char* value) {
    Document document;
    document.*member = value;
    return document;
  };
  expect_error(file(with(&Document::count, "4")), "accessor 0", "do not fit");
  expect_error(file(with(&Document::count, "4000000000")), "accessor 0", "do not fit");
  expect_error(file(with(&Document::count, "2")), "index 2", "names vertex 2, but there are 2");
  expect_error(file(with(&Document::index_count, "4")), "accessor 1", "do not fit");
  expect_error(file(with(&Document::index_count, "2")), "primitive 0", "no whole number of triangles");
  expect_error(file(with(&Document::index_type, "5126")), "", "");
  expect_error(file(with(&Document::index_offset, "400")), "accessor 1", "begins outside");
  expect_error(file(with(&Document::view_length, "360")), "", "");
  expect_error(file(with(&Document::nodes, R"([{"mesh":7}])")), "t.gltf", "names mesh 7, but there are 1");
  expect_error(file(with(&Document::scene_nodes, "[3]")), "t.gltf", "names node 3");
  expect_error(file(with(&Document::primitive, R"({"attributes":{"POSITION":9},"indices":1})")), "t.gltf",
               "names accessor 9");
  expect_error(file(with(&Document::buffer, R"({"byteLength":42,"uri":"absent.bin"})")), "t.gltf", "no glTF file");
}

TEST_F(OneTriangle, in_nodes_that_form_no_tree_is_an_error) {
  Document circle;
  circle.nodes = R"([{"children":[1]},{"children":[0],"mesh":0}])";
  expect_error(file(circle), "node 0", "reached twice");
  Document projection;
  projection.nodes = R"([{"mesh":0,"matrix":[1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])";
  expect_error(file(projection), "node 0", "projection");
  Document overflow;
  overflow.nodes = R"([{"mesh":0,"scale":[1e39,1,1]}])";
  expect_error(file(overflow), "vertex 1", "too large");
}

TEST_F(OneTriangle, compressed_by_an_extension_is_refused) {
  Document document;
  std::string json = document.json();
  const std::string view = R"("bufferView":0,)";
  json.erase(json.find(view), view.size());
  write("t.bin", triangle_bytes());
  expect_error(write("draco.gltf", json), "accessor 0", "sparse or compressed");
}

TEST_F(OneTriangle, of_nan_is_an_error) {
  std::string bytes = triangle_bytes();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bytes.replace(16, 4, reinterpret_cast<const char*>(&nan), 4);
  const std::string name = file({});
  write("t.bin", bytes);
  expect_error(name, "vertex 1", "NaN");
}

TEST_F(GltfTest, a_file_cut_off_anywhere_is_an_error) {
  Document document;
  document.buffer = R"({"byteLength":42})";
  const std::string whole = glb(document.json(), triangle_bytes());
  write("t.bin", triangle_bytes());
  const std::string text = Document().json();
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 3)
    EXPECT_THROW(load(write("cut.glb", whole.substr(0, bytes))), Error) << bytes;
  for (std::size_t bytes = 0; bytes < text.size(); bytes += 3)
    EXPECT_THROW(load(write("cut.gltf", text.substr(0, bytes))), Error) << bytes;
}

TEST_F(GltfTest, a_file_without_meshes_is_an_error) {
  expect_error(write("empty.gltf", R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[]}]})"), "empty.gltf",
               "no triangles");
}

TEST_F(OneTriangle, values_nested_without_end_are_refused_before_the_library_recurses_into_them) {
  Document document;
  const auto nested = [](int depth) {
    return ",\"extras\":" + std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']');
  };
  document.extra = nested(99);
  EXPECT_EQ(load(file(document)).mesh.triangles.size(), 1u);
  document.extra = nested(100);
  expect_error(file(document), "t.gltf", "nested more than 100 deep");
  document.extra = nested(1'000'000);
  expect_error(file(document), "t.gltf", "nested more than 100 deep");
}

TEST_F(OneTriangle, a_chunk_that_claims_what_lies_behind_its_file_is_refused) {
  Document document;
  document.buffer = R"({"byteLength":42})";
  std::string bytes = glb(document.json(), triangle_bytes());
  const std::size_t chunk = bytes.size() - 44 - 8;  // the library itself forgets these eight bytes of the header
  bytes[chunk] = static_cast<char>(bytes[chunk] + 8);
  expect_error(write("t.glb", bytes), "t.glb: byte", "bytes of the binary chunk need more than");
}

TEST_F(OneTriangle, a_buffer_without_bytes_or_that_is_no_file_is_refused) {
  Document document;
  document.buffer = R"({"byteLength":0})";
  expect_error(write("t.glb", glb(document.json(), triangle_bytes())), "t.glb", "is no glTF file");
  document.buffer = R"({"byteLength":42,"uri":"."})";
  expect_error(file(document), "t.gltf", "is a folder");
}

TEST_F(OneTriangle, buffers_that_each_copy_the_one_chunk_are_refused) {
  Document document;
  document.buffer = R"({"byteLength":1000000})";
  for (int i = 0; i < 300; ++i) document.buffer += R"(,{"byteLength":1000000})";
  expect_error(write("t.glb", glb(document.json(), std::string(1'000'000, '\0'))), "t.glb",
               "301 buffers share a binary chunk");
}

}  // namespace
}  // namespace ctu::scene::test
