// Whether a trace's nodes carry masks, all, some or none, when a model of cost and benefit chose that.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ctu::traces {

/// What one way to cull is expected to do for the rays of the trace.
struct CullingForecast {
  std::string name;  ///< "off", "on", "partial"
  double cycles_per_ray = 0, intersections_per_ray = 0;
  std::uint32_t node_bytes = 0;    ///< of a node that carries masks, or of every node when none does
  std::uint64_t image_bytes = 0;   ///< of all nodes and triangles
  std::uint64_t masked_nodes = 0;  ///< nodes with at least one mask that is not full
  bool operator==(const CullingForecast&) const = default;
};

struct CullingChoice {
  std::string choice;            ///< name of the forecast that was followed; empty: nobody chose
  std::string why;               ///< in a sentence
  std::string design;            ///< mask-test design of the unit that the forecasts are for
  std::string config_hash;       ///< of that unit
  std::uint64_t pilot_rays = 0;  ///< that were simulated for each forecast
  std::vector<CullingForecast> forecasts;
  bool operator==(const CullingChoice&) const = default;
};

}  // namespace ctu::traces
