// Makes a trace of a scene: tree, masks, image, then the rays with what they must find and what each design visits.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/accel/build.h"
#include "model/accel/image.h"
#include "model/cull/options.h"
#include "model/scene/scene.h"
#include "traces/culling_choice.h"
#include "traces/local_trees.h"
#include "traces/manifest.h"
#include "traces/mask_set.h"
#include "traces/ray_options.h"
#include "traces/ray_packets.h"
#include "traces/ray_trees.h"

namespace ctu::traces {

struct RecordOptions {
  RayOptions rays;
  RayPackets packets;
  RayTrees trees;
  accel::BuildOptions build;
  cull::MaskOptions masks;
  bool with_masks = true;   ///< false: nodes carry none, and the only design is None
  bool strip_full = false;  ///< nodes whose masks are all full carry none
  /// Alignments, bits of a coordinate, and primitive_boxes, with which ray boxes cull in the leaves of every design;
  /// mask_bits follow from `masks`.
  accel::ImageLayout layout;
  /// Whose steps are stored. Projection, Dedup and BitTable store MaskLut's, which are their own.
  std::vector<cull::Design> designs = {cull::Design::None, cull::Design::MaskLut, cull::Design::Comparators};
  std::vector<cull::Design> count_only;  ///< counted for the manifest, not stored
  std::uint32_t rays_per_block = 16384;  ///< at most; 1 .. kMaxRaysPerBlock
  float strand_thickness = 0;            ///< as the scene was loaded, for the manifest
  int threads = 1;                       ///< the file is the same for any number
};

/// What rays are recorded on.
struct RecordedTree {
  accel::Bvh4 bvh;
  MaskSet masks;                            ///< empty when nodes carry none
  std::uint32_t bare_nodes = 0;             ///< the last ones, laid out without masks
  std::shared_ptr<const LocalTrees> local;  ///< which `bvh` holds behind the first tree; null: not asked for
  CullingChoice culling;                    ///< for the manifest, when somebody chose the masks
  double build_seconds = 0, mask_seconds = 0, compression_seconds = 0;
};

/// The tree of a scene with all masks, or none, as the options say; its boxes are those of layout.box_bits. Throws
/// Error on options out of range.
RecordedTree build_tree(const scene::Scene& scene, const RecordOptions& options);

/// Lays nodes whose masks are all full out without masks: once the masks are chosen, because it reorders the nodes.
void strip_full(RecordedTree& tree);

struct RecordSummary {
  std::uint64_t rays = 0;
  std::uint64_t file_bytes = 0;
  std::uint64_t image_bytes = 0;
  std::uint32_t nodes = 0, triangles = 0;
  std::uint32_t node_stride_bytes = 0;
  std::uint32_t bare_nodes = 0;
  int compression_entries = 0;                                       ///< 0: masks are not compressed
  std::uint64_t packets = 0, packet_visits = 0, packet_entries = 0;  ///< zero where rays travel alone
  std::uint32_t trees = 1;
  /// Rays that walk a local tree; tests of all rays in their trees, and in the one over the whole scene.
  std::uint64_t local_rays = 0, own_tests = 0, global_tests = 0;
  double build_seconds = 0, mask_seconds = 0, compression_seconds = 0, trace_seconds = 0;
  std::vector<DesignCounts> designs;    ///< stored ones first
  std::vector<Difference> differences;  ///< the first kMaxListedDifferences; all are counted in `designs`
  std::string hash;                     ///< trace hash
};

/// Called with paths done and paths in all, from one thread at a time.
using RecordProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// Records to `path`. A hit with culling that differs from the hit without is counted and listed, and the trace keeps
/// the one without as the expected hit. Throws Error on options out of range and on a file that cannot be written.
RecordSummary record(const scene::Scene& scene, const RecordOptions& options, const std::string& path,
                     const RecordProgress& progress = {});

/// The same on a tree that is there, whose masks may have been chosen since: all, some or (options.with_masks false)
/// none.
RecordSummary record(const scene::Scene& scene, const RecordOptions& options, const RecordedTree& tree,
                     const std::string& path, const RecordProgress& progress = {});

}  // namespace ctu::traces
