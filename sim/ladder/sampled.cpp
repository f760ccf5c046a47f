#include "sim/ladder/sampled.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/engine.h"
#include "sim/ladder/chunk_feed.h"
#include "sim/ladder/chunk_plan.h"
#include "sim/ladder/recorded_counts.h"

namespace ctu::ladder {
namespace {

using pipeline::UnitResult;

// What a chunk's rays and visits do not say of its cycles, relative: what the first draw goes by.
constexpr double kExpectedSpread = 0.08;
constexpr std::uint64_t kFewestChunks = 48;  ///< of the first draw
constexpr std::uint64_t kFewestMore = 16;    ///< of a later one
constexpr double kLargestShare = 0.5;        ///< of the rays, warm-up included: from there on all are simulated
constexpr double kFirstShare = 0.25;         ///< likewise, of the first draw
constexpr double kReserve = 1.15;            ///< chunks drawn beyond what the first ones say are needed
constexpr int kDraws = 5;

/// What the manifest knows of the whole work: rays always, visits if they were counted.
struct Known {
  Sizes sizes{};
  std::size_t count = 1;
};

Known known_of(const TraceWork& work, const reference::Counts* counts) {
  Known known;
  known.sizes[0] = static_cast<double>(std::min(work.range.last, work.reader.rays()) - work.range.first);
  if (counts == nullptr) return known;
  known.sizes[1] = static_cast<double>(counts->node_visits);
  known.sizes[2] = static_cast<double>(counts->leaf_visits);
  known.count = kSizes;
  return known;
}

Sizes sizes_of(const Window& window) { return {window.rays, window.node_visits, window.leaf_visits}; }

std::uint64_t lines(const pipeline::UnitConfig& config, int bytes) {
  return static_cast<std::uint64_t>(bytes / config.memory.line_bytes);
}

struct Chunking {
  ChunkSizes sizes;
  WarmUp warm_up;

  std::uint64_t rays_of_chunk() const { return sizes.measured + warm_up.most_simulated_rays; }
  std::uint64_t rays_always() const { return sizes.head + sizes.tail + warm_up.most_simulated_rays; }
};

/// How much warm-up leaves no bias was measured (docs/ladder.md, "How a chunk begins").
Chunking chunking_for(const pipeline::UnitConfig& config) {
  const auto contexts = static_cast<std::uint64_t>(config.unit.contexts);
  const std::uint64_t cached = lines(config, config.node_cache.bytes) + lines(config, config.leaf_cache.bytes);
  Chunking c;
  c.sizes.measured = std::max<std::uint64_t>(64, 16 * contexts);
  c.sizes.head = c.sizes.measured;
  c.sizes.tail = c.sizes.measured / 2;
  c.warm_up.contexts = contexts;
  // The tables' cache is not shown anything: it fills while rays are simulated.
  c.warm_up.simulated_rays = 3 * contexts + lines(config, config.table_cache.bytes) / 16;
  c.warm_up.simulated_work = 256 * contexts;
  c.warm_up.most_simulated_rays = std::max(c.warm_up.simulated_rays, 24 * contexts);
  c.warm_up.shown_visits = 16 * cached;
  c.warm_up.most_shown_rays = 4 * cached;
  return c;
}

/// In each number as much as the one that asks for more.
Chunking larger(const Chunking& a, const Chunking& b) {
  Chunking c = a;
  const auto raise = [](auto& mine, const auto& theirs, const auto... members) {
    ((mine.*members = std::max(mine.*members, theirs.*members)), ...);
  };
  raise(c.sizes, b.sizes, &ChunkSizes::measured, &ChunkSizes::head, &ChunkSizes::tail);
  raise(c.warm_up, b.warm_up, &WarmUp::contexts, &WarmUp::simulated_rays, &WarmUp::simulated_work,
        &WarmUp::most_simulated_rays, &WarmUp::shown_visits, &WarmUp::most_shown_rays);
  return c;
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
    known_ = known_of(work, counts_);
  }

  void draw(const ChunkPlan& plan, const WarmUp& warm_up) {
    ChunkFeed feed(work_, plan, warm_up);
    pipeline::EngineOptions options;
    options.keep_events = true;
    const auto engine = pipeline::make_engine(config_, {image_, work_.tester, feed}, options);
    feed.run(*engine);
    const UnitResult part = engine->result();
    Draw& draw = draws_.emplace_back();
    draw.share_of_groups = plan.share_of_blocks;
    draw.share_within = plan.share_of_cells;
    ends_ = {};
    add_end(feed.drain());
    for (std::size_t i = 0; i < plan.chunks.size(); ++i) {
      const Window& window = feed.windows()[i];
      if (plan.chunks[i].drawn)
        draw.chunks.push_back({window.cycles, sizes_of(window), plan.chunks[i].group});
      else
        add_end(window);
    }
    simulated_rays_ += part.rays;
    simulated_cycles_ += part.cycles;
    chunks_ += plan.chunks.size();
    add(sum_, part);
  }

  /// Cycles of the whole work.
  Total total() const {
    Sizes between = known_.sizes;
    for (std::size_t i = 0; i < kSizes; ++i) between[i] = std::max(0.0, between[i] - ends_.sizes[i]);
    Total total = estimate_total(draws_, between, known_.count);
    total.value += ends_.value;
    return total;
  }
  const std::vector<Draw>& draws() const { return draws_; }
  std::uint64_t simulated_rays() const { return simulated_rays_; }
  std::uint64_t chunks() const { return chunks_; }

  Sampled result(double confidence) {
    const Total total = this->total();
    const double half = half_width(draws_, total, confidence);
    Sampled s;
    s.cycles_low = total.value - half;
    s.cycles_high = total.value + half;
    s.chunks = chunks_;
    s.simulated_rays = simulated_rays_;
    s.simulated_cycles = simulated_cycles_;
    scale(total.value, known_.sizes[0]);
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

 private:
  /// Head, tail and what comes behind the last ray: part of every draw, and the same in all but for what lies in
  /// caches.
  void add_end(const Window& window) {
    ends_.value += window.cycles;
    const Sizes sizes = sizes_of(window);
    for (std::size_t i = 0; i < kSizes; ++i) ends_.sizes[i] += sizes[i];
  }

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
  Known known_;
  std::vector<Draw> draws_;
  Measure ends_;
  UnitResult sum_;
  std::uint64_t simulated_rays_ = 0, simulated_cycles_ = 0, chunks_ = 0;
};

/// Draws more chunks until half the interval, relative, is as small as asked; false when that takes too many rays.
template <class DrawPlan, class Reached>
bool draw_until_sharp(const TraceWork& work, const Chunking& chunking, const SampledOptions& options,
                      const DrawPlan& draw, const Reached& reached) {
  std::mt19937_64 random(options.seed);
  const std::uint64_t rays = std::min(work.range.last, work.reader.rays()) - work.range.first;
  const auto chunks_in = [&](double share) {
    const double left = share * static_cast<double>(rays) - static_cast<double>(chunking.rays_always());
    return static_cast<std::uint64_t>(std::max(0.0, left / static_cast<double>(chunking.rays_of_chunk())));
  };
  const std::uint64_t most = chunks_in(kLargestShare), first = chunks_in(kFirstShare);
  if (first < kFewestChunks) return false;
  const double expected = 2 * kExpectedSpread / options.error;
  std::uint64_t drawn = 0;
  std::uint64_t wanted = std::clamp(static_cast<std::uint64_t>(expected * expected), kFewestChunks, first);
  for (int i = 0; i < kDraws; ++i) {
    if (drawn + wanted > most) return false;
    const ChunkPlan plan = plan_chunks(work, wanted, chunking.sizes, random);
    draw(plan);
    drawn += plan.chunks.size();
    const double ratio = reached() / options.error;
    if (ratio <= 1) return true;
    const double needed = static_cast<double>(drawn) * ratio * ratio * kReserve;
    wanted = static_cast<std::uint64_t>(std::min(needed, 1e15)) + 1 - drawn;
    wanted = std::max(wanted, kFewestMore);
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
  const Chunking chunking = chunking_for(config);
  const bool sharp = draw_until_sharp(
      work, chunking, options, [&](const ChunkPlan& plan) { sampler.draw(plan, chunking.warm_up); },
      [&] {
        const Total total = sampler.total();
        return half_width(sampler.draws(), total, options.confidence) / total.value;
      });
  return sharp ? sampler.result(options.confidence) : sampler.run_all();
}

Comparison compare_sampled(const Side& first, const Side& second, const SampledOptions& options) {
  require_possible(options);
  Sampler a(first.work, first.image, first.config), b(second.work, second.image, second.config);
  const Chunking chunking = larger(chunking_for(first.config), chunking_for(second.config));
  const auto ratio = [&] { return estimate_ratio(a.draws(), b.total(), a.total(), options.confidence); };
  const bool sharp = draw_until_sharp(
      first.work, chunking, options,
      [&](const ChunkPlan& plan) {
        a.draw(plan, chunking.warm_up);
        b.draw(plan, chunking.warm_up);
      },
      [&] {
        const Ratio reached = ratio();
        return reached.half_width / reached.value;
      });
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
