// Answers held against those without culling, and those against all triangles: how many differ, and what that means.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/cull/options.h"
#include "model/intersect/ray.h"
#include "model/scene/scene.h"
#include "sim/metamorph/answers.h"
#include "sim/metamorph/world.h"

namespace ctu::sim::metamorph {

/// Told of every defect, in words.
using TellDefect = std::function<void(const std::string& words)>;

struct HitChanges {
  std::uint64_t lost = 0, near_misses = 0, ties = 0;
  std::uint64_t all() const { return lost + near_misses + ties; }
  HitChanges& operator+=(const HitChanges& other);
};

/// "closest-hit origin ... direction ... t [..., ...]" in hexadecimal, and "primitive 7 at ..." or "nothing".
std::string words(const intersect::Ray& ray);
std::string words(const intersect::Hit& hit);

/// The rays with every design's answers; the first are those without culling.
struct Asked {
  std::vector<intersect::Ray> rays;
  std::vector<Answers> answers;
  std::vector<intersect::Hit> best;  ///< of all triangles
};
Asked ask_all(const World& world, std::vector<intersect::Ray> rays, int threads, Record record);

/// The answers without culling are held against the best of all triangles (any-hit: whether there is one), those of the
/// designs against the answers without culling, bit for bit.
HitChanges judge_hits(const scene::Mesh& mesh, const World& world, const Asked& asked, const TellDefect& tell);

/// Triangles that rays found forwards (`from`, one for each ray of `asked`) and that they meet backwards as well, in
/// exact arithmetic: every design must find them or something before them.
struct WayBack {
  std::uint64_t lost = 0;
  std::uint64_t declined = 0;  ///< by the triangle test itself, on the way back
};
WayBack judge_way_back(const scene::Mesh& mesh, const World& world, const Asked& asked,
                       const std::vector<std::uint32_t>& from, const TellDefect& tell);

}  // namespace ctu::sim::metamorph
