// Whether culling pays for a scene on a given unit, and in which nodes (the paper's Bedroom, Ninja and Classroom get
// slower with it). A sample of the rays decides: simulated without masks, with all of them, and with those that pay;
// the costs by which masks are weighed are what the first two simulations say that rays pay for visits and look-ups.
#pragma once

#include "model/pipeline/result.h"
#include "model/pipeline/unit_config.h"
#include "model/scene/scene.h"
#include "sim/mask_worth.h"
#include "sim/ray_sample.h"
#include "traces/recorder.h"

namespace ctu::sim {

struct DecisionOptions {
  pipeline::UnitConfig config;
  std::uint64_t pilot_rays = 32768;  ///< about so many are simulated for each forecast, and as many others weigh masks
};

struct CullingDecision {
  traces::RecordedTree tree;  ///< with the masks chosen, nodes that need none laid out bare, and what was said
  bool with_masks = true;     ///< false: culling does not pay, nodes carry no masks
};

/// Decides for the rays, masks and layout of `recorded`. `tree`: as build_tree() makes it, with all masks. The same for
/// any number of threads.
CullingDecision decide_culling(const scene::Scene& scene, traces::RecordedTree tree,
                               const traces::RecordOptions& recorded, const DecisionOptions& options);

struct SampleRun {
  pipeline::UnitResult unit;
  std::uint32_t node_bytes = 0;  ///< stride of nodes that carry masks, or of all when none does
  std::uint64_t image_bytes = 0;
  double cycles_per_ray() const;
};

/// The unit's run over the sample, on the image of this tree with its masks; without culling when not `with_masks`. The
/// rays travel as recorded.packets has it, in the sample's order.
SampleRun simulate_sample(const traces::RecordedTree& tree, bool with_masks, const RaySample& sample,
                          const traces::RecordOptions& recorded, const pipeline::UnitConfig& config);

/// What rays paid for their visits, from the runs without and with masks.
VisitCosts measured_costs(const pipeline::UnitResult& off, const pipeline::UnitResult& on,
                          const pipeline::UnitConfig& config);

}  // namespace ctu::sim
