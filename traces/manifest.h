// What a trace says about itself: how it was made, what is in it, and what was counted. JSON in the file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/accel/build.h"
#include "model/accel/image.h"
#include "model/cull/options.h"
#include "model/intersect/ray.h"
#include "model/reference/step.h"
#include "model/scene/scene.h"
#include "traces/columns.h"
#include "traces/culling_choice.h"
#include "traces/ray_options.h"
#include "traces/ray_packets.h"
#include "traces/ray_trees.h"

namespace ctu::traces {

inline constexpr std::uint32_t kMaxRaysPerBlock = 1u << 20;
inline constexpr std::size_t kMaxListedDifferences = 64;

struct SceneInfo {
  std::string name;            ///< as given to scene::load
  std::string hash;            ///< scene::content_hash, 32 digits
  float strand_thickness = 0;  ///< scene::LoadOptions
  std::uint64_t triangles = 0, spheres = 0;
  scene::Camera camera;
  scene::LoadReport report;
};

/// What a design visits for the rays of the trace.
struct DesignCounts {
  cull::Design design = cull::Design::None;
  bool stored = false;  ///< its steps are in the trace
  reference::Counts counts;
  std::uint64_t different_hits = 0;  ///< rays whose hit with this design is not the expected one, bit for bit
};

struct Difference {
  cull::Design design = cull::Design::None;
  std::uint64_t ray = 0;
  intersect::Hit expected, culled;
};

/// The image but for its bytes.
struct ImageInfo {
  accel::Image shape;  ///< its `bytes` are empty
  std::uint64_t size_bytes = 0;
};

struct Manifest {
  std::string tool;  ///< name and version of the program that wrote the file
  SceneInfo scene;
  RayOptions rays;
  RayPackets packets;
  RayTrees trees;
  accel::BuildOptions build;
  cull::MaskOptions masks;
  CullingChoice culling;  ///< how it was decided which nodes carry masks; of no effect on what the trace is
  ImageInfo image;
  std::uint64_t ray_count = 0;
  std::vector<DesignCounts> designs;
  std::vector<Difference> differences;  ///< the first kMaxListedDifferences
  std::string cut_from;                 ///< trace hash of the file that this is a slice of
  std::uint64_t cut_first = 0;          ///< ... and the number its first ray has there
  std::vector<Section> sections;

  const DesignCounts* find(cull::Design design) const;
  /// Minor version of the file: the least that has all that is in it.
  std::uint16_t format_minor() const;
};

std::string to_json(const Manifest& manifest);
/// Throws Error, at `path`, on text that is no manifest: the member and what is wrong with it.
Manifest manifest_from_json(const std::string& text, const std::string& path);

/// What identifies a trace beside its columns: the format, the scene, and how tree, masks and image were made.
std::string identity_text(const Manifest& manifest);

}  // namespace ctu::traces
