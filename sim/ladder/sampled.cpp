#include "sim/ladder/sampled.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/engine.h"
#include "sim/ladder/chunk_plan.h"
#include "sim/ladder/recorded_counts.h"

namespace ctu::ladder {
namespace {

using pipeline::UnitResult;

// How far neighbouring chunks differ, relative: what the first draw goes by, so that few come after it.
constexpr double kExpectedSpread = 0.14;
constexpr std::uint64_t kFewestChunks = 48;
constexpr double kLargestShare = 0.5;  ///< of the rays, warm-up included: from there on all are simulated
constexpr double kReserve = 1.15;      ///< chunks drawn beyond what the first ones say are needed
constexpr int kDraws = 5;

/// What the chunks of one draw took: sums by unit.
struct Measured {
  Drawn cycles_by_visits, cycles_by_rays;
};

/// Gives the chunks' rays one part after the other, and notes cycle and events whenever the unit has taken the last ray
/// of a part and asks for more.
class ChunkFeed : public reference::RayFeed {
 public:
  ChunkFeed(const TraceWork& work, const ChunkPlan& plan) : work_(work), plan_(plan), measured_(plan.units) {}

  void watch(const pipeline::Engine& engine) { engine_ = &engine; }
  std::uint64_t total_rays() const override {
    std::uint64_t rays = 0;
    for (const Chunk& chunk : plan_.chunks) rays += chunk.last - chunk.warm;
    return rays;
  }

  std::shared_ptr<const reference::RayBlock> next() override {
    if (measuring_) note();
    while (next_chunk_ < plan_.chunks.size()) {
      const Chunk& chunk = plan_.chunks[next_chunk_];
      if (!begun_) {
        begun_ = true;
        at_ = chunk.warm;
      }
      if (at_ < chunk.first) return part(at_, chunk.first);
      if (at_ < chunk.last) {
        start_ = now();
        measuring_ = true;
        return part(at_, chunk.last);
      }
      ++next_chunk_;
      begun_ = false;
    }
    return nullptr;
  }

  Measured measured(double share) const {
    Measured m;
    m.cycles_by_visits.share = m.cycles_by_rays.share = share;
    for (const Sums& sums : measured_) {
      m.cycles_by_visits.parts.push_back({sums.cycles, sums.events});
      m.cycles_by_rays.parts.push_back({sums.cycles, sums.rays});
    }
    return m;
  }

 private:
  struct Sums {
    double cycles = 0, events = 0, rays = 0;
  };
  struct Moment {
    double cycle = 0, events = 0;
  };

  Moment now() const {
    if (engine_ == nullptr) return {};
    return {static_cast<double>(engine_->now()), static_cast<double>(engine_->log().events().size())};
  }

  /// Rays from `first` on, as far as their block reaches.
  std::shared_ptr<const reference::RayBlock> part(std::uint64_t first, std::uint64_t last) {
    const std::uint64_t number = work_.reader.block_of(first);
    if (block_ == nullptr || number != block_number_) {
      const traces::RayRange whole{work_.reader.first_ray(number), work_.reader.first_ray(number + 1)};
      block_ = traces::TraceFeed(work_.reader, whole, work_.bvh, work_.masks, work_.tester).next();
      block_number_ = number;
    }
    last = std::min(last, block_->first_ray + block_->rays.size());
    rays_in_part_ = static_cast<double>(last - first);
    at_ = last;
    return std::make_shared<const reference::RayBlock>(
        traces::part_of(*block_, first - block_->first_ray, last - block_->first_ray));
  }

  void note() {
    const Moment end = now();
    Sums& sums = measured_[plan_.chunks[next_chunk_].unit];
    sums.cycles += end.cycle - start_.cycle;
    sums.events += end.events - start_.events;
    sums.rays += rays_in_part_;
    measuring_ = false;
  }

  const TraceWork& work_;
  const ChunkPlan& plan_;
  const pipeline::Engine* engine_ = nullptr;
  std::shared_ptr<const reference::RayBlock> block_;
  std::uint64_t block_number_ = 0, at_ = 0;
  std::size_t next_chunk_ = 0;
  bool begun_ = false, measuring_ = false;
  Moment start_;
  double rays_in_part_ = 0;
  std::vector<Sums> measured_;
};

/// Contexts fill within twice their number of rays; a cache is up to date when what the chunks before have left in it
/// and other rays would have thrown out is gone, which takes rays in proportion to its lines.
ChunkSizes sizes_for(const pipeline::UnitConfig& config) {
  const auto contexts = static_cast<std::uint64_t>(config.unit.contexts);
  const auto lines =
      static_cast<std::uint64_t>(std::max(config.node_cache.bytes, config.leaf_cache.bytes) / config.memory.line_bytes);
  ChunkSizes sizes;
  sizes.warm = 2 * contexts + lines / 16;
  sizes.measured = std::max<std::uint64_t>(64, 2 * contexts);
  sizes.first_warm = sizes.warm + lines;
  return sizes;
}

void add(UnitResult& sum, const UnitResult& other) {
  if (sum.stages.empty()) {
    sum = other;
    return;
  }
  sum.cycles += other.cycles;
  sum.rays += other.rays;
  sum.wrong_hits += other.wrong_hits;
  sum.counts += other.counts;
  sum.ray_latency_sum += other.ray_latency_sum;
  for (std::size_t i = 0; i < sum.stages.size(); ++i) {
    sum.stages[i].busy += other.stages[i].busy;
    sum.stages[i].idle += other.stages[i].idle;
    for (std::size_t c = 0; c < sum.stages[i].stalled.size(); ++c)
      sum.stages[i].stalled[c].cycles += other.stages[i].stalled[c].cycles;
  }
  for (std::size_t i = 0; i < sum.ray_cycles.size() && i < other.ray_cycles.size(); ++i)
    sum.ray_cycles[i].cycles += other.ray_cycles[i].cycles;
  for (std::size_t i = 0; i < sum.counters.size() && i < other.counters.size(); ++i)
    sum.counters[i].value = is_extreme(sum.counters[i].name) ? std::max(sum.counters[i].value, other.counters[i].value)
                                                             : sum.counters[i].value + other.counters[i].value;
}

/// One unit and its draws.
class Sampler {
 public:
  Sampler(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config)
      : work_(work), image_(image), config_(config) {
    if (work.reader.manifest().packets.any())
      throw Error("--engine sampled", "the rays of this trace travel in packets, which chunks would cut",
                  "give --engine cycle, or record without --packets");
    counts_ = recorded_counts(work);
  }

  void draw(const ChunkPlan& plan) {
    ChunkFeed feed(work_, plan);
    pipeline::EngineOptions options;
    options.keep_events = true;
    const auto engine = pipeline::make_engine(config_, {image_, work_.tester, feed}, options);
    feed.watch(*engine);
    const UnitResult part = pipeline::run_to_end(*engine);
    const Measured measured = feed.measured(plan.share);
    by_visits_.push_back(measured.cycles_by_visits);
    by_rays_.push_back(measured.cycles_by_rays);
    simulated_rays_ += part.rays;
    simulated_cycles_ += part.cycles;
    chunks_ += plan.chunks.size();
    add(sum_, part);
  }

  /// Cycles of a visit, or of a ray where the visits of the whole work are not known.
  Ratio ratio(double confidence) const {
    return estimate_ratio(counts_ != nullptr ? by_visits_ : by_rays_, confidence);
  }
  /// Cycles of rays, draw by draw.
  const std::vector<Drawn>& by_rays() const { return by_rays_; }
  std::uint64_t simulated_rays() const { return simulated_rays_; }
  std::uint64_t chunks() const { return chunks_; }

  Sampled result(double confidence) {
    const auto rays = static_cast<double>(rays_in_all());
    const double size =
        counts_ != nullptr ? static_cast<double>(counts_->node_visits + counts_->leaf_visits) + rays : rays;
    const Ratio ratio = this->ratio(confidence);
    // The last rays still have their way to go when all are taken.
    const double drain = static_cast<double>(sum_.ray_latency_sum) / static_cast<double>(sum_.rays);
    Sampled s;
    const double cycles = ratio.value * size + drain;
    s.cycles_low = cycles - ratio.half_width * size;
    s.cycles_high = cycles + ratio.half_width * size;
    s.chunks = chunks_;
    s.simulated_rays = simulated_rays_;
    s.simulated_cycles = simulated_cycles_;
    scale(cycles, rays);
    s.result = std::move(sum_);
    return s;
  }

  Sampled run_all() {
    traces::TraceFeed feed(work_.reader, work_.range, work_.bvh, work_.masks, work_.tester);
    Sampled s;
    s.result = pipeline::run_to_end(*pipeline::make_engine(config_, {image_, work_.tester, feed}, {}));
    s.cycles_low = s.cycles_high = static_cast<double>(s.result.cycles);
    s.chunks = 1;
    s.simulated_rays = simulated_rays_ + s.result.rays;
    s.simulated_cycles = simulated_cycles_ + s.result.cycles;
    s.whole = true;
    return s;
  }

  std::uint64_t rays_in_all() const { return std::min(work_.range.last, work_.reader.rays()) - work_.range.first; }

 private:
  /// The sums of the sample become those of the whole.
  void scale(double cycles, double rays) {
    const double by_cycles = cycles / static_cast<double>(sum_.cycles);
    const double by_rays = rays / static_cast<double>(sum_.rays);
    const double seen = static_cast<double>(sum_.counts.node_visits + sum_.counts.leaf_visits);
    const double by_visits = counts_ != nullptr && seen > 0
                                 ? static_cast<double>(counts_->node_visits + counts_->leaf_visits) / seen
                                 : by_rays;
    const auto scaled = [](std::uint64_t value, double factor) {
      return static_cast<std::uint64_t>(std::llround(static_cast<double>(value) * factor));
    };
    sum_.cycles = static_cast<std::uint64_t>(std::llround(cycles));
    sum_.rays = static_cast<std::uint64_t>(rays);
    sum_.counts = counts_ != nullptr ? *counts_ : scaled_counts(sum_.counts, by_rays, sum_.rays);
    for (auto& stage : sum_.stages) {
      stage.busy = scaled(stage.busy, by_cycles);
      for (auto& cause : stage.stalled) cause.cycles = scaled(cause.cycles, by_cycles);
      std::uint64_t accounted = stage.busy;
      for (const auto& cause : stage.stalled) accounted += cause.cycles;
      stage.idle = sum_.cycles - std::min(sum_.cycles, accounted);
    }
    sum_.ray_latency_sum = 0;
    for (auto& cause : sum_.ray_cycles) sum_.ray_latency_sum += cause.cycles = scaled(cause.cycles, by_rays);
    for (auto& counter : sum_.counters)
      if (!is_extreme(counter.name)) counter.value = scaled(counter.value, by_visits);
    sum_.left_out.clear();
    sum_.event_log_hash = 0;
  }

  TraceWork work_;
  const accel::Image& image_;
  const pipeline::UnitConfig& config_;
  const reference::Counts* counts_ = nullptr;
  std::vector<Drawn> by_visits_, by_rays_;
  UnitResult sum_;
  std::uint64_t simulated_rays_ = 0, simulated_cycles_ = 0, chunks_ = 0;
};

/// Draws more chunks until `ratio()` is as sharp as asked; false when that takes too many rays.
template <class Draw, class RatioOf>
bool draw_until_sharp(const TraceWork& work, const ChunkSizes& sizes, const SampledOptions& options, const Draw& draw,
                      const RatioOf& ratio_of) {
  std::mt19937_64 random(options.seed);
  const std::uint64_t rays = std::min(work.range.last, work.reader.rays()) - work.range.first;
  const auto most = static_cast<std::uint64_t>(kLargestShare * static_cast<double>(rays) /
                                               static_cast<double>(sizes.warm + sizes.measured));
  const double expected = 2 * kExpectedSpread / options.error;
  std::uint64_t drawn = 0, wanted = std::max(kFewestChunks, static_cast<std::uint64_t>(expected * expected));
  wanted = std::min(wanted, std::max<std::uint64_t>(kFewestChunks, most / 3));
  for (int i = 0; i < kDraws; ++i) {
    if (drawn + wanted > most) return false;
    const ChunkPlan plan = plan_chunks(work, wanted, sizes, random);
    draw(plan);
    drawn += plan.chunks.size();
    const Ratio ratio = ratio_of();
    const double reached = ratio.half_width / ratio.value;
    if (reached <= options.error) return true;
    const double needed = static_cast<double>(drawn) * (reached / options.error) * (reached / options.error) * kReserve;
    wanted = static_cast<std::uint64_t>(std::min(needed, 1e15)) + 1 - drawn;
    wanted = std::max<std::uint64_t>(wanted, 8);
  }
  return false;
}

}  // namespace

void require_possible(const SampledOptions& options) {
  if (!(options.error >= 1e-4 && options.error <= 1))
    throw Error("--error", fmt::format("{} % is out of range", 100 * options.error), "choose from 0.01% to 100%");
  if (!(options.confidence >= 0.5 && options.confidence <= 0.9999))
    throw Error("--confidence", fmt::format("{} % is out of range", 100 * options.confidence),
                "choose from 50% to 99.99%");
}

Sampled run_sampled(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config,
                    const SampledOptions& options) {
  require_possible(options);
  Sampler sampler(work, image, config);
  const bool sharp = draw_until_sharp(
      work, sizes_for(config), options, [&](const ChunkPlan& plan) { sampler.draw(plan); },
      [&] { return sampler.ratio(options.confidence); });
  return sharp ? sampler.result(options.confidence) : sampler.run_all();
}

Comparison compare_sampled(const Side& first, const Side& second, const SampledOptions& options) {
  require_possible(options);
  Sampler a(first.work, first.image, first.config), b(second.work, second.image, second.config);
  const auto ratio = [&] {
    std::vector<Drawn> draws = b.by_rays();
    for (std::size_t d = 0; d < draws.size(); ++d)
      for (std::size_t i = 0; i < draws[d].parts.size(); ++i) draws[d].parts[i].below = a.by_rays()[d].parts[i].above;
    return estimate_ratio(draws, options.confidence);
  };
  ChunkSizes sizes = sizes_for(first.config);
  const ChunkSizes others = sizes_for(second.config);
  sizes = {std::max(sizes.warm, others.warm), std::max(sizes.measured, others.measured),
           std::max(sizes.first_warm, others.first_warm)};
  const bool sharp = draw_until_sharp(
      first.work, sizes, options,
      [&](const ChunkPlan& plan) {
        a.draw(plan);
        b.draw(plan);
      },
      ratio);
  Comparison comparison;
  comparison.chunks = a.chunks();
  if (sharp) {
    comparison.ratio = ratio();
  } else {
    comparison.ratio.value =
        static_cast<double>(b.run_all().result.cycles) / static_cast<double>(a.run_all().result.cycles);
    comparison.chunks = 1;
  }
  comparison.simulated_rays = a.simulated_rays() + b.simulated_rays();
  return comparison;
}

}  // namespace ctu::ladder
