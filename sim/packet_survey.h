// What packets save or cost in the unit on one scene: the same rays alone and in packets of several sizes with several
// numbers of entries.
#pragma once

#include <functional>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "model/scene/scene.h"
#include "traces/recorder.h"

namespace ctu::sim {

struct PacketSurveyOptions {
  pipeline::UnitConfig config;
  std::vector<int> sizes, entries;  ///< all of them with all of these
  reference::Forming forming = reference::Forming::Order;
  int window = 1024;
  std::uint64_t rays = 0;  ///< sampled, about so many; 0: all
};

/// A unit's run over the sample; plan.size 0: the rays alone.
struct PacketRun {
  reference::PacketPlan plan;
  double node_tests = 0, triangle_tests = 0;       ///< by single rays, a ray
  double packet_visits = 0, node_tests_saved = 0;  ///< nodes that packets visited, and tests above the entries, a ray
  double entries = 0;                              ///< of a packet, on average
  double memory_lines = 0, cycles = 0;             ///< a ray
  std::uint64_t lost = 0, near_misses = 0, ties = 0;  ///< hits that are not those of the rays alone, by exact judgement
};

/// The first run is that of the rays alone, in the order in which they come.
std::vector<PacketRun> survey_packets(const scene::Scene& scene, const traces::RecordedTree& tree,
                                      const traces::RecordOptions& recorded, const PacketSurveyOptions& options,
                                      const std::function<void(std::uint64_t)>& runs_done);

}  // namespace ctu::sim
