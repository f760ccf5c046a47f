// Small scenes and traces for the tests of this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "traces/recorder.h"
#include "traces/trace_reader.h"

namespace ctu::traces::test {

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// CTU_TEST_SEED, or `otherwise`.
std::uint64_t test_seed(std::uint64_t otherwise);

/// A square of two triangles in the plane z = 0, corners at +-half, seen from +z.
scene::Scene square_scene(float half);

/// Loose thin triangles and a camera; a few hundred nodes.
scene::Scene hair_scene();

/// 24x16 pixels, paths of up to 3 bounces, blocks of 100 rays.
RecordOptions small_options();

std::vector<std::uint8_t> read_bytes(const std::string& path);
void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes);

/// Reads everything that can be read: image, every block with every stored design, walks checked.
struct Content {
  std::string hash;
  std::vector<std::uint8_t> image;
  std::vector<reference::RayBlock> blocks;  ///< for each block: plain, then once for each stored design
};
Content read_all(const std::string& path);
bool same(const Content& a, const Content& b);
bool same_rays(const std::vector<intersect::Ray>& a, const std::vector<intersect::Ray>& b);
bool same_hits(const std::vector<intersect::Hit>& a, const std::vector<intersect::Hit>& b);
bool same_steps(const reference::StepList& a, const reference::StepList& b);

}  // namespace ctu::traces::test
