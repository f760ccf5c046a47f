#include "sim/ladder/chunk_plan.h"

#include <algorithm>

namespace ctu::ladder {
namespace {

// Reading a block costs about as much as simulating one of its chunks, and neighbouring blocks differ far less than
// neighbouring chunks: so several chunks of a block make a sample of a given sharpness cheapest.
constexpr std::uint64_t kChunksOfBlock = 4;   ///< where not every block is read, at most about so many
constexpr std::uint64_t kCellsOfStretch = 4;  ///< likewise, at least
constexpr std::uint64_t kFewestBlocks = 32;   ///< likewise: fewer do not say how much they differ

/// 0 <= number < bound, the same on every machine.
std::uint64_t below(std::uint64_t bound, std::mt19937_64& random) {
  return static_cast<std::uint64_t>((static_cast<unsigned __int128>(random()) * bound) >> 64);
}

std::uint64_t divided_up(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

/// Of how many blocks, and of how many cells of a block, one is drawn.
struct Density {
  std::uint64_t blocks = 1, cells = 1;
};

Density density_for(std::uint64_t blocks, std::uint64_t cells, std::uint64_t wanted) {
  Density density;
  density.blocks = std::max<std::uint64_t>(1, blocks / std::max(kFewestBlocks, divided_up(wanted, kChunksOfBlock)));
  density.cells = cells / (density.blocks * wanted);
  if (density.cells < kCellsOfStretch && density.blocks > 1)
    density = {1, cells / wanted};  // dense enough to be spread over all blocks
  density.cells = std::max<std::uint64_t>(1, density.cells);
  return density;
}

}  // namespace

ChunkPlan plan_chunks(const TraceWork& work, std::uint64_t wanted, const ChunkSizes& sizes, std::mt19937_64& random) {
  const std::uint64_t begin = work.range.first, end = std::min(work.range.last, work.reader.rays());
  const std::uint64_t first = begin + sizes.head, last = end - sizes.tail;
  const std::uint64_t first_block = work.reader.block_of(first), end_block = work.reader.block_of(last - 1) + 1;
  const Density density = density_for(end_block - first_block, divided_up(last - first, sizes.measured),
                                      std::max<std::uint64_t>(1, wanted));
  ChunkPlan plan;
  plan.share_of_blocks = 1 / static_cast<double>(density.blocks);
  plan.share_of_cells = 1 / static_cast<double>(density.cells);
  if (sizes.head > 0) plan.chunks.push_back({begin, first, 0, false});
  for (std::uint64_t stretch = first_block; stretch < end_block; stretch += density.blocks) {
    const std::uint64_t block = stretch + below(density.blocks, random);
    if (block >= end_block) continue;
    const std::uint64_t from = std::max(first, work.reader.first_ray(block)),
                        to = std::min(last, work.reader.first_ray(block + 1));
    for (std::uint64_t cell = 0; from + cell * sizes.measured < to; cell += density.cells) {
      const std::uint64_t start = from + (cell + below(density.cells, random)) * sizes.measured;
      if (start < to) plan.chunks.push_back({start, std::min(to, start + sizes.measured), block, true});
    }
  }
  if (sizes.tail > 0) plan.chunks.push_back({last, end, end_block, false});
  return plan;
}

}  // namespace ctu::ladder
