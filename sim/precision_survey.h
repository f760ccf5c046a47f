// What boxes of fewer bits cost and save on one scene: the same rays through units whose images differ in the bits of a
// coordinate alone.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/cull/options.h"
#include "model/pipeline/unit_config.h"
#include "model/scene/scene.h"
#include "traces/recorder.h"

namespace ctu::sim {

struct PrecisionOptions {
  pipeline::UnitConfig config;          ///< its design is replaced by each of
  std::vector<cull::Design> designs;    ///< ... these
  std::vector<std::uint32_t> box_bits;  ///< the first one is what the others are compared with
  std::uint64_t rays = 0;               ///< sampled, about so many; 0: all
};

/// One image and one design.
struct PrecisionRun {
  std::uint32_t box_bits = 32;
  cull::Design design = cull::Design::None;
  std::uint32_t node_bytes = 0;
  std::uint64_t image_bytes = 0;
  double intersections_per_ray = 0, node_bytes_per_ray = 0, cycles_per_ray = 0;
  double memory_lines_per_ray = 0;                         ///< nodes and leaves
  std::uint64_t lost_hits = 0, near_misses = 0, ties = 0;  ///< against the walk of the first box_bits without culling
};

struct PrecisionSurvey {
  std::uint64_t triangles = 0, nodes = 0, rays = 0;
  std::vector<PrecisionRun> runs;  ///< of each of box_bits all designs
};

/// The rays are those of the first box_bits' tree, so that all runs have the same; every hit found by a run's walk is
/// compared with the one found there, bit for bit, and the unit's runs replay these walks.
PrecisionSurvey survey_precision(const scene::Scene& scene, const traces::RecordOptions& recorded,
                                 const PrecisionOptions& options, const std::function<void(std::uint64_t)>& runs_done);

}  // namespace ctu::sim
