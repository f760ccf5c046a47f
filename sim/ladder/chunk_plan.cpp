#include "sim/ladder/chunk_plan.h"

#include <algorithm>

namespace ctu::ladder {
namespace {

constexpr std::uint64_t kChunksOfBlock = 8;  ///< where not every block is read

/// 0 <= number < bound, the same on every machine.
std::uint64_t below(std::uint64_t bound, std::mt19937_64& random) {
  return static_cast<std::uint64_t>((static_cast<unsigned __int128>(random()) * bound) >> 64);
}

class Planner {
 public:
  Planner(const ChunkSizes& sizes, std::mt19937_64& random) : sizes_(sizes), random_(random) {}

  /// `count` chunks in rays [first, last), one in each equal part; those before `begin` are not there.
  void add(std::uint64_t begin, std::uint64_t first, std::uint64_t last, std::uint64_t count, bool own_units) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t from = first + (last - first) * i / count, to = first + (last - first) * (i + 1) / count;
      const std::uint64_t length = std::min(sizes_.measured, to - from);
      const std::uint64_t start = from + below(to - from - length + 1, random_);
      const std::uint64_t warm = plan_.chunks.empty() ? sizes_.first_warm : sizes_.warm;
      const std::uint64_t free = plan_.chunks.empty() ? begin : std::max(begin, plan_.chunks.back().last);
      plan_.chunks.push_back({std::max(free, start - std::min(start, warm)), start, start + length, plan_.units});
      if (own_units) ++plan_.units;
    }
    if (!own_units) ++plan_.units;
  }
  ChunkPlan take(double share) {
    plan_.share = share;
    return std::move(plan_);
  }

 private:
  ChunkSizes sizes_;
  std::mt19937_64& random_;
  ChunkPlan plan_;
};

}  // namespace

ChunkPlan plan_chunks(const TraceWork& work, std::uint64_t wanted, const ChunkSizes& sizes, std::mt19937_64& random) {
  const std::uint64_t first = work.range.first, last = std::min(work.range.last, work.reader.rays());
  const std::uint64_t rays = last - first;
  wanted = std::clamp<std::uint64_t>(wanted, 1, std::max<std::uint64_t>(1, rays / sizes.measured));
  const std::uint64_t first_block = work.reader.block_of(first),
                      blocks = work.reader.block_of(last - 1) + 1 - first_block;
  Planner planner(sizes, random);
  const std::uint64_t some = (wanted + kChunksOfBlock - 1) / kChunksOfBlock;
  if (2 * some >= blocks) {
    planner.add(first, first, last, wanted, true);
    return planner.take(static_cast<double>(wanted * sizes.measured) / static_cast<double>(rays));
  }
  for (std::uint64_t i = 0; i < some; ++i) {
    const std::uint64_t from = blocks * i / some, to = blocks * (i + 1) / some;
    const std::uint64_t block = first_block + from + below(to - from, random);
    const std::uint64_t begin = std::max(first, work.reader.first_ray(block));
    planner.add(begin, begin, std::min(last, work.reader.first_ray(block + 1)), kChunksOfBlock, false);
  }
  return planner.take(static_cast<double>(some) / static_cast<double>(blocks));
}

}  // namespace ctu::ladder
