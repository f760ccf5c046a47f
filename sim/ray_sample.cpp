#include "sim/ray_sample.h"

#include <algorithm>
#include <cmath>

#include "model/base/parallel.h"
#include "model/reference/block_walk.h"

namespace ctu::sim {
namespace {

using intersect::Hit;
using intersect::Ray;

constexpr std::size_t kRaysPerBlock = 4096;
constexpr std::uint64_t kProbePaths = 16;  ///< of each run, to learn how many rays a path has
constexpr double kGoldenRatio = 0.6180339887498949;

struct PathRange {
  std::uint64_t first = 0, last = 0;
};

/// One range in each of `runs` equal parts of the paths. Golden-ratio steps keep the starts from following the rows of
/// the picture.
std::vector<PathRange> spread(std::uint64_t paths, std::uint64_t runs, std::uint64_t paths_per_run, double phase) {
  std::vector<PathRange> ranges;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const std::uint64_t first = paths * run / runs, last = paths * (run + 1) / runs;
    const std::uint64_t length = std::min(paths_per_run, last - first);
    const double turn = std::fmod(phase + static_cast<double>(run) * kGoldenRatio, 1.0);
    const std::uint64_t start = first + static_cast<std::uint64_t>(turn * static_cast<double>(last - first - length));
    ranges.push_back({start, start + length});
  }
  return ranges;
}

std::uint64_t runs_of(const SampleOptions& options) {
  constexpr std::uint64_t kRaysPerRun = 1024, kMostRuns = 32;
  if (options.runs > 0) return static_cast<std::uint64_t>(options.runs);
  return options.rays == 0 ? kMostRuns : std::min(options.rays / kRaysPerRun, kMostRuns);
}

RaySample trace(const traces::RayGenerator& generator, const reference::Traversal& without_culling,
                const std::vector<PathRange>& ranges, int threads) {
  const auto closest = [&](const Ray& ray, bool) { return without_culling.trace(ray); };
  std::vector<RaySample> parts(ranges.size());
  parallel_chunks(ranges.size(), 1, threads, [&](std::size_t i, std::size_t) {
    generator.generate(ranges[i].first, ranges[i].last, closest, parts[i].rays, parts[i].hits);
  });
  RaySample sample;
  for (const RaySample& part : parts) {
    sample.rays.insert(sample.rays.end(), part.rays.begin(), part.rays.end());
    sample.hits.insert(sample.hits.end(), part.hits.begin(), part.hits.end());
  }
  return sample;
}

}  // namespace

RaySample sample_rays(const traces::RayGenerator& generator, const reference::Traversal& without_culling,
                      const SampleOptions& options, int threads) {
  const std::uint64_t paths = generator.paths();
  const std::uint64_t runs = std::clamp<std::uint64_t>(runs_of(options), 1, paths);
  std::uint64_t paths_per_run = (paths + runs - 1) / runs;
  if (options.rays != 0) {
    const RaySample probe = trace(generator, without_culling, spread(paths, runs, kProbePaths, options.phase), threads);
    const double probed = static_cast<double>(runs * std::min(kProbePaths, std::max<std::uint64_t>(1, paths / runs)));
    const double rays_per_path = std::max(static_cast<double>(probe.rays.size()) / probed, 1e-3);
    const double wanted = static_cast<double>(options.rays) / static_cast<double>(runs) / rays_per_path;
    if (2 * wanted < static_cast<double>(paths_per_run)) paths_per_run = static_cast<std::uint64_t>(std::ceil(wanted));
  }
  const auto ranges = spread(paths, runs, paths_per_run, options.phase);
  RaySample sample = trace(generator, without_culling, ranges, threads);
  std::uint64_t sampled = 0;
  for (const PathRange& range : ranges) sampled += range.last - range.first;
  sample.whole = sampled == paths;
  return sample;
}

SampleFeed::SampleFeed(const RaySample& sample, const accel::Bvh4& bvh, const cull::ObjectMasks* masks,
                       const cull::MaskTester& tester, const reference::PacketPlan& packets)
    : sample_(sample), packets_(packets), traversal_(bvh, masks, tester) {}

std::shared_ptr<const reference::RayBlock> SampleFeed::next() {
  if (next_ray_ == sample_.rays.size()) return nullptr;
  const std::size_t last = std::min(sample_.rays.size(), next_ray_ + kRaysPerBlock);
  auto block = std::make_shared<reference::RayBlock>();
  block->first_ray = next_ray_;
  for (; next_ray_ < last; ++next_ray_) {
    block->rays.push_back(sample_.rays[next_ray_]);
    block->expected.push_back(sample_.hits[next_ray_]);
  }
  if (packets_.any())
    block->packets = reference::cut_packets(static_cast<std::uint32_t>(block->rays.size()), packets_.size);
  const std::vector<intersect::Hit> found = reference::walk_block(traversal_, packets_, *block);
  if (packets_.any()) reference::expect_any_hits_found(block->rays, found, block->expected);
  return block;
}

}  // namespace ctu::sim
