// Which rays are simulated when not all are: short chunks of consecutive rays, one at a random place in each of equally
// long stretches of the trace. On long traces the stretches lie in some blocks only, evenly spread, because a block is
// read as a whole.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

/// Rays [first, last) are measured; those from `warm` on are simulated before.
struct Chunk {
  std::uint64_t warm = 0, first = 0, last = 0;
  std::size_t unit = 0;  ///< chunks of one unit are one part of the sample
};

struct ChunkPlan {
  std::vector<Chunk> chunks;  ///< in their order
  std::size_t units = 0;
  double share = 0;  ///< of all units
};

struct ChunkSizes {
  std::uint64_t warm = 0, measured = 0, first_warm = 0;  ///< first_warm: before the first chunk, with its cold caches
};

/// About `wanted` chunks.
ChunkPlan plan_chunks(const TraceWork& work, std::uint64_t wanted, const ChunkSizes& sizes, std::mt19937_64& random);

}  // namespace ctu::ladder
