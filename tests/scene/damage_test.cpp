// Any file of any format, damaged anywhere, either loads as a valid scene or is refused with an Error.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "model/base/error.h"
#include "model/scene/random.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

std::uint64_t test_seed() {
  const char* text = std::getenv("CTU_TEST_SEED");
  return text == nullptr ? 20240229 : std::strtoull(text, nullptr, 10);
}

// One to four damages: a byte changed, a run of bytes removed, doubled, or a large number put in.
std::string damaged(std::string bytes, Random& random) {
  const int damages = 1 + static_cast<int>(random.bits() % 4);
  for (int i = 0; i < damages && !bytes.empty(); ++i) {
    const std::size_t at = random.bits() % bytes.size(), run = 1 + random.bits() % 8;
    switch (random.bits() % 5) {
      case 0:
        bytes[at] = static_cast<char>(random.bits());
        break;
      case 1:
        bytes.erase(at, run);
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, run));
        break;
      case 3:
        bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at), "\xff\xff\xff\x7f", 4);
        break;
      default:
        bytes.insert(at, "99999999");
        break;
    }
  }
  return bytes;
}

class Damage : public SceneFiles {
 protected:
  void survive(const std::string& name, const std::string& good, int rounds) {
    const std::uint64_t seed = test_seed();
    RecordProperty("seed", std::to_string(seed));
    ASSERT_NO_THROW(load(write(name, good)));
    int loaded = 0, refused = 0;
    for (int round = 0; round < rounds; ++round) {
      SCOPED_TRACE(fmt::format("CTU_TEST_SEED={} round {}; the file is the last one written", seed, round));
      Random random(seed, static_cast<std::uint64_t>(round));
      write(name, damaged(good, random));
      try {
        check(load(path(name)));
        ++loaded;
      } catch (const Error&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 0);
    EXPECT_EQ(loaded + refused, rounds);
  }

  static void check(const Scene& scene) {
    EXPECT_FALSE(scene.mesh.triangles.empty());
    for (const auto& triangle : scene.mesh.triangles)
      for (const std::uint32_t index : triangle) ASSERT_LT(index, scene.mesh.vertices.size());
    for (const Vec3& v : scene.mesh.vertices)
      ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
  }
};

const std::string kAsciiPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0.1\n0 1 0\n3 0 1 2\n3 0 2 3\n";
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nvn 0 0 1\nf 1 2 3\nf 1//1 3//1 4//1\nf -1 -2 -3 -4\n";
const std::string kPbrt =
    "LookAt 1 2 3 4 5 6 0 0 1\nCamera \"perspective\" \"float fov\" [50]\nWorldBegin\nAttributeBegin\nScale 2 2 2\n"
    "ObjectBegin \"leaf\"\nShape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [1 0 0 0 1 0 0 0 "
    "1]\nObjectEnd\n"
    "AttributeEnd\nRotate 30 1 2 3\nObjectInstance \"leaf\"\nTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 "
    "1]\nObjectInstance \"leaf\"\n";
const std::string kNff =
    "v\nfrom 1 2 3\nat 0 0 1\nup 0 0 1\nangle 40\nf 1 1 1 1 1 1 1 1\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\np 3\n0 0 5\n1 0 "
    "5\n0 1 5\n";
const std::vector<std::vector<Vec3>> kStrands = {{{0, 0, 0}, {0, 0, 1}, {0, 1, 2}}, {{5, 0, 0}, {6, 1, 0}, {7, 1, 0}}};

std::string binary_ply() {
  Bytes bytes;
  bytes.add(
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty double y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty list uint float uv\nend_header\n");
  for (int i = 0; i < 3; ++i) bytes.add(float(i)).add(double(i * i)).add(1.0f);
  bytes.add(std::uint8_t{3}).add(0).add(1).add(2).add(std::uint32_t{2}).add(0.5f).add(0.5f);
  return bytes.text();
}

std::string glb_triangle() {
  Bytes bytes;
  for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) bytes.add(v);
  for (const std::uint16_t i : {0, 1, 2}) bytes.add(i);
  return glb(
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"scale":[1,2,3]},)"
      R"({"mesh":0,"translation":[1,2,3],"rotation":[0,0,1,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
      R"("indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,)"
      R"("componentType":5123,"count":3,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":36},)"
      R"({"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":42}]})",
      bytes.text());
}

TEST_F(Damage, never_breaks_loading_an_ascii_ply) { survive("a.ply", kAsciiPly, 3000); }
TEST_F(Damage, never_breaks_loading_a_binary_ply) { survive("a.ply", binary_ply(), 3000); }
TEST_F(Damage, never_breaks_loading_an_obj) { survive("a.obj", kObj, 3000); }
TEST_F(Damage, never_breaks_loading_a_glb) { survive("a.glb", glb_triangle(), 3000); }
TEST_F(Damage, never_breaks_loading_a_pbrt) { survive("a.pbrt", kPbrt, 3000); }
TEST_F(Damage, never_breaks_loading_a_hair) { survive("a.hair", hair_file(kStrands, 0.1f, true), 3000); }
TEST_F(Damage, never_breaks_loading_a_tfx) { survive("a.tfx", tfx_file(kStrands), 3000); }
TEST_F(Damage, never_breaks_loading_an_nff) { survive("a.nff", kNff, 3000); }
TEST_F(Damage, never_breaks_loading_a_compressed_file) { survive("a.obj.zst", compressed(kObj), 3000); }

}  // namespace
}  // namespace ctu::scene::test
