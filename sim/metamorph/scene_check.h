// Metamorphic checks of a whole scene: what must stay the same when the scene is scaled, moved, permuted, mirrored,
// when its rays are reversed, and when rays run through the edges of what is closed in it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "sim/metamorph/hit_changes.h"
#include "sim/metamorph/leaks.h"
#include "sim/metamorph/transformation.h"
#include "sim/metamorph/world.h"
#include "traces/ray_options.h"

namespace ctu::sim::metamorph {

struct CheckOptions {
  std::vector<traces::RayOptions> rays;  ///< a kind each
  WorldOptions world;
  std::vector<Kind> kinds;  ///< of transformations
  bool reversed = true, edges = true;
  std::uint64_t seed = 1;
  std::uint64_t most_aimed = 20000;  ///< rays at edges and vertices; 0: at all of them
};

/// Whether what must be the same, bit for bit, is.
enum class Same : std::uint8_t { NotPromised, Yes, No };

/// One transformation of one scene.
struct CheckRow {
  std::string name;
  Kind kind = Kind::Identity;
  std::uint64_t rays = 0;
  HitChanges changed{};            ///< of all designs together, None included
  std::uint64_t declined = 0;      ///< reversed: triangles exactly met whose own rounded test declines the way back
  std::uint64_t not_compared = 0;  ///< rays of which the same bits are not promised (keeps_bits)
  Same same = Same::NotPromised;
};

/// Rays at the edges and vertices of closed parts.
struct EdgeRow {
  std::uint64_t parts = 0, triangles = 0, edges = 0, vertices = 0, folds = 0;
  std::uint64_t rays = 0;
  Leaks found;
};

struct SceneReport {
  std::uint64_t triangles = 0;
  std::vector<CheckRow> rows;
  bool edges_checked = false;
  EdgeRow edges;
  std::vector<std::string> left_out;  ///< transformations, and why
  std::vector<std::string> defects;   ///< in words, at most kMostDefects of a scene
  bool passed() const;
};
inline constexpr std::size_t kMostDefects = 40;

/// `progress` is told the name of what is checked next.
SceneReport check_scene(const scene::Scene& scene, const CheckOptions& options,
                        const std::function<void(const std::string& next)>& progress);

}  // namespace ctu::sim::metamorph
