// The chunks of a plan as the rays of one unit, one chunk behind the other; notes what the unit does between the taking
// of a chunk's first ray and the taking of its last one.
//
// What a chunk finds in the unit is to be what it would find in a run of all rays:
//   contexts  rays of the chunk before are still under way, which were met as they are in any place of the trace; so
//             many rays are simulated in front of a chunk that these have come to their end, and long rays of its own
//             place are under way instead. A rule in rays alone would not do: those that miss everything pass in no
//             time.
//   caches    are shown what the rays before visit, in their order, without time passing; the node and leaf caches hold
//             what was used last, so what they hold depends on few thousand visits. This comes in the middle of the
//             simulated rays: rays of the chunk before would fetch what belongs to their own place behind it.
// Chunks that follow without a gap need neither.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "model/pipeline/engine.h"
#include "sim/ladder/chunk_plan.h"
#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

/// What happens while the rays of a chunk are taken: visits that end, whosever they are.
struct Window {
  double cycles = 0, rays = 0, node_visits = 0, leaf_visits = 0;
};

/// In front of a chunk.
struct WarmUp {
  std::size_t contexts = 1;  ///< rays under way at a time
  /// Rays are simulated until there are so many, and rays and visits together so many, or there are the most.
  std::uint64_t simulated_rays = 0, simulated_work = 0, most_simulated_rays = 0;
  std::uint64_t shown_visits = 0, most_shown_rays = 0;  ///< to the caches: until one of the two is reached
};

class ChunkFeed : public reference::RayFeed {
 public:
  /// `plan` must outlive it.
  ChunkFeed(const TraceWork& work, const ChunkPlan& plan, const WarmUp& warm_up);

  /// Simulates all chunks. The engine was made of this feed, keeps its events, and has not been advanced.
  void run(pipeline::Engine& engine);

  /// Of each chunk, in order.
  const std::vector<Window>& windows() const { return windows_; }
  /// From the taking of the last chunk's last ray to the end of the run.
  const Window& drain() const { return drain_; }

  std::shared_ptr<const reference::RayBlock> next() override;
  /// Of the chunks.
  std::uint64_t total_rays() const override;

 private:
  struct Moment {
    double cycle = 0;
    std::size_t events = 0;
  };
  Moment now() const;
  Window since(const Moment& start) const;
  void begin_chunk();
  std::uint64_t warm_up_begin(std::uint64_t end, double share);
  void show_caches();
  void show_rays(const reference::RayBlock& block, std::uint64_t next, std::uint64_t last);
  const reference::RayBlock& block(std::uint64_t number);
  std::shared_ptr<const reference::RayBlock> part(std::uint64_t last);

  TraceWork work_;
  const ChunkPlan& plan_;
  WarmUp warm_up_;
  pipeline::Engine* engine_ = nullptr;
  std::vector<std::pair<std::uint64_t, std::shared_ptr<const reference::RayBlock>>> blocks_;  ///< the last ones read
  std::size_t chunk_ = 0;
  std::uint64_t done_ = 0, at_ = 0;  ///< end of the chunk before, next ray of this one
  std::uint64_t shown_ = 0;          ///< when its turn comes, caches are shown what lies in front of it
  bool measuring_ = false;
  Moment start_;
  std::vector<Window> windows_;
  Window drain_;
};

}  // namespace ctu::ladder
