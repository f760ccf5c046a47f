#include "tests/traces/test_support.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include "model/accel/image.h"
#include "model/scene/load.h"
#include "traces/validate_block.h"

namespace ctu::traces::test {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "ctu-traces-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) std::abort();
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::uint64_t test_seed(std::uint64_t otherwise) {
  const char* text = std::getenv("CTU_TEST_SEED");
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 0);
}

scene::Scene square_scene(float half) {
  scene::Scene scene;
  scene.name = "square";
  scene.mesh.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.lower = {-half, -half, 0};
  scene.upper = {half, half, 0};
  scene.camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90, true};
  return scene;
}

scene::Scene hair_scene() { return scene::load("gen:hair-ball?strands=150&segments=4&thickness=0.08&seed=3"); }

RecordOptions small_options() {
  RecordOptions options;
  options.rays.kind = RayOptions::Rays::Diffuse;
  options.rays.width = 24;
  options.rays.height = 16;
  options.rays.bounces = 3;
  options.rays_per_block = 100;
  return options;
}

std::vector<std::uint8_t> read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

Content read_all(const std::string& path) {
  Content content;
  const TraceReader reader(path);
  content.hash = reader.hash();
  const accel::Image image = reader.read_image();
  content.image = image.bytes;
  const accel::Bvh4 bvh = accel::decode(image);
  for (std::uint64_t block = 0; block < reader.blocks(); ++block) {
    content.blocks.push_back(reader.read_block(block));
    for (const DesignCounts& design : reader.manifest().designs) {
      if (!design.stored) continue;
      content.blocks.push_back(reader.read_block(block, design.design));
      validate_block(content.blocks.back(), bvh, reader.manifest().masks, path, reader.manifest().packets.plan);
    }
  }
  return content;
}

namespace {
template <class T>
bool same_memory(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_ray(const intersect::Ray& a, const intersect::Ray& b) {
  const float left[] = {a.origin.x,    a.origin.y,    a.origin.z,    a.tmin,
                        a.direction.x, a.direction.y, a.direction.z, a.tmax};
  const float right[] = {b.origin.x,    b.origin.y,    b.origin.z,    b.tmin,
                         b.direction.x, b.direction.y, b.direction.z, b.tmax};
  return std::memcmp(left, right, sizeof left) == 0 && a.kind == b.kind;
}
}  // namespace

bool same_rays(const std::vector<intersect::Ray>& a, const std::vector<intersect::Ray>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_ray);
}

bool same_hits(const std::vector<intersect::Hit>& a, const std::vector<intersect::Hit>& b) { return same_memory(a, b); }

bool same_steps(const reference::StepList& a, const reference::StepList& b) {
  return a.first_step == b.first_step && a.first_key == b.first_key && a.tail_dropped == b.tail_dropped &&
         same_memory(a.steps, b.steps) && a.keys == b.keys && a.first_met == b.first_met && a.met == b.met;
}

bool same(const Content& a, const Content& b) {
  const auto same_block = [](const reference::RayBlock& x, const reference::RayBlock& y) {
    return x.first_ray == y.first_ray && same_rays(x.rays, y.rays) && same_hits(x.expected, y.expected) &&
           same_steps(x.steps, y.steps) && x.packets == y.packets;
  };
  return a.hash == b.hash && a.image == b.image &&
         std::equal(a.blocks.begin(), a.blocks.end(), b.blocks.begin(), b.blocks.end(), same_block);
}

}  // namespace ctu::traces::test
