// Runs configurations on a sample of each trace's rays, fast and side by side: what the search asks.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/pipeline/unit_config.h"
#include "model/reference/ray_block.h"
#include "sim/energy/gate_area.h"
#include "sim/energy/unit_shape.h"
#include "sim/loaded_trace.h"

namespace ctu::tailor {

/// A configuration's cycles on each trace's sample; none where it cannot run it.
struct Trial {
  std::vector<std::uint64_t> cycles;
  std::string refusal;  ///< why it cannot
  bool ran() const { return refusal.empty(); }
};

class Workbench {
 public:
  /// The sample: `rays` of each trace in eight runs of consecutive ones spread over it, all where it has fewer; 0: all.
  /// Error when a trace cannot be read.
  Workbench(const std::vector<std::string>& traces, std::uint64_t rays);
  ~Workbench();

  std::size_t traces() const { return benches_.size(); }
  const sim::LoadedTrace& trace(std::size_t i) const;
  /// Rays of trace i's sample.
  std::uint64_t sampled(std::size_t i) const;
  /// Whether every trace's masks can answer this design.
  bool has_masks_for(cull::Design design) const;

  /// The unit that this trace needs in this configuration.
  energy::UnitShape shape(std::size_t i, const pipeline::UnitConfig& config);
  /// Estimated um2 of the unit that serves all traces: memories and gates by the tables; what the search minimises.
  double area(const pipeline::UnitConfig& config);

  /// Replays the samples without SystemC; remembered by configuration.
  const Trial& run(const pipeline::UnitConfig& config);
  /// Several at once, on so many threads.
  void run_all(const std::vector<pipeline::UnitConfig>& configs, int threads);
  std::size_t runs() const { return trials_.size(); }

 private:
  struct Bench;
  struct Prepared;
  Trial measure(const pipeline::UnitConfig& config);
  const Prepared& prepared(Bench& bench, cull::Design design);

  std::vector<std::unique_ptr<Bench>> benches_;
  std::mutex mutex_;
  std::map<std::string, Trial> trials_;
};

}  // namespace ctu::tailor
