// Which rays are simulated when not all are: the first and the last ones always, and between them short chunks of
// consecutive rays, one at random in each of equally long stretches of a block, in one block at random of each so many.
// Blocks are what a trace is read in, so a long trace is not read as a whole.
//
// Every chunk that could be drawn is drawn with the same probability: a block is laid out in cells of `measured` rays,
// one of each so many cells is drawn, and one of each so many blocks; at the end of a block and of the trace, where
// fewer are left, what would lie behind the end is drawn as nothing.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

/// Rays [first, last).
struct Chunk {
  std::uint64_t first = 0, last = 0;
  std::size_t group = 0;  ///< chunks of one block are one group
  bool drawn = true;      ///< else always there
};

struct ChunkPlan {
  std::vector<Chunk> chunks;                       ///< in their order
  double share_of_blocks = 1, share_of_cells = 1;  ///< drawn, of all blocks and of the cells of a drawn one
};

struct ChunkSizes {
  std::uint64_t measured = 0;        ///< rays of a chunk
  std::uint64_t head = 0, tail = 0;  ///< rays at the begin and the end of the work that are always simulated
};

/// About `wanted` chunks are drawn; the work has more rays than its head and its tail.
ChunkPlan plan_chunks(const TraceWork& work, std::uint64_t wanted, const ChunkSizes& sizes, std::mt19937_64& random);

}  // namespace ctu::ladder
