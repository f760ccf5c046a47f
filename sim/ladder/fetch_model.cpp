#include "sim/ladder/fetch_model.h"

#include <algorithm>
#include <cmath>

namespace ctu::ladder {
namespace {

/// P(N < ways) when N of `trials` fall into a place that each hits with probability `share`.
double fewer_than(int ways, double trials, double share) {
  if (share >= 1) return trials < ways ? 1 : 0;
  double term = std::exp(trials * std::log1p(-share)), sum = term;
  for (int k = 1; k < ways && k <= trials; ++k) {
    term *= (trials - k + 1) / k * share / (1 - share);
    sum += term;
  }
  return std::min(sum, 1.0);
}

/// Visits in the middle of an age bucket.
double age_of(int bucket) {
  if (bucket == 0) return 1;
  const int octave = (bucket + 1) / 2, upper_half = (bucket + 1) % 2;
  return std::ldexp(1.0, octave) * (upper_half == 1 ? 1.75 : 1.25);
}

/// Probability that a line is on its way where nothing is kept: a line used again after `others` other lines is asked
/// for once and then found until it has come, `lines` being on their way at once.
double under_way(double lines, int group) {
  if (group == kCapacities) return 0;
  const double others = 0.5 * ((group == 0 ? 0 : capacity(group - 1)) + capacity(group));
  return others < lines ? lines / (lines + others) : 0;
}

/// Probability that a set-associative cache with least-recently-used replacement holds a line of a group: the other
/// lines used since fall into its sets at random (Hill and Smith 1989, "Evaluating associativity in CPU caches",
/// section 5), but for those of one visit, which follow each other and so fall into different sets.
double held_in(double sets, int ways, double lines_per_visit, int group) {
  if (group == kCapacities) return 0;
  const double from = group == 0 ? 0 : capacity(group - 1), to = capacity(group);
  const double run = std::clamp(lines_per_visit, 1.0, sets);
  constexpr int kPoints = 8;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double others = from + (to - from) * (i + 0.5) / kPoints;
    sum += fewer_than(ways, others / run, run / sets);
  }
  return sum / kPoints;
}

}  // namespace

CacheModel::CacheModel(const pipeline::CacheConfig& cache, const pipeline::MemoryConfig& memory, int contexts,
                       double lines_per_visit, double lines_under_way)
    : ports_(cache.ports), keeps_lines_(cache.bytes > 0) {
  // Without a cache a line can be found only while a miss register waits for it.
  const double lines =
      keeps_lines_ ? static_cast<double>(cache.bytes) / memory.line_bytes : std::min(cache.mshrs, contexts);
  for (int g = 0; g < kGroups; ++g)
    held_[static_cast<std::size_t>(g)] =
        keeps_lines_ ? held_in((lines + lines_under_way) / cache.ways, cache.ways, lines_per_visit, g)
                     : under_way(lines, g);
  size_class_ =
      std::clamp(static_cast<int>(std::lround(std::log2(std::max(1.0, lines / capacity(0))) / 2)), 0, kSizeClasses - 1);
  const double banks = memory.model == pipeline::MemoryModel::Banked ? memory.banks * memory.channels : 0;
  for (int b = 0; b < kRowBuckets && banks > 0; ++b)
    open_[static_cast<std::size_t>(b)] = std::pow(1 - 1 / banks, 1.5 * std::ldexp(1.0, b) - 1);
}

FetchModel::FetchModel(const LineProfile& profile, const CacheModel& cache, double rays)
    : profile_(profile), cache_(cache), rays_(rays) {
  FetchDemand& d = demand_;
  d.visits = static_cast<double>(profile.visits) / rays;
  d.lookups = static_cast<double>(profile.lookups) / rays;
  for (int g = 0; g < kGroups; ++g) {
    const double missed = 1 - cache.held(g);
    d.lines += missed * static_cast<double>(profile.lines[static_cast<std::size_t>(g)]) / rays;
    d.missing_visits += missed * static_cast<double>(profile.by_farthest[static_cast<std::size_t>(g)]) / rays;
  }
  for (int n = 1; n <= kMostLines; ++n) {
    const double visits = static_cast<double>(profile.by_lines[static_cast<std::size_t>(n)]) / rays;
    const double cycles = (n + cache.ports() - 1) / cache.ports();
    d.cycles += visits * cycles;
    d.squared_cycles += visits * cycles * cycles;
  }
  double lost = 0, open = 0;  // lines that a cache of the class loses
  for (int g = 4 * cache.size_class() + 1; g < kGroups; ++g)
    lost += static_cast<double>(profile.lines[static_cast<std::size_t>(g)]);
  const auto& distance = profile.row_distance[static_cast<std::size_t>(cache.size_class())];
  for (int b = 0; b < kRowBuckets; ++b)
    open += cache.open(b) * static_cast<double>(distance[static_cast<std::size_t>(b)]);
  d.open_rows = lost == 0 ? 0 : d.lines * open / lost;
}

double FetchModel::joined(double window) const {
  if (!cache_.keeps_lines()) return 0.5 * (demand_.visits - demand_.missing_visits);
  const auto& recent = profile_.recent[static_cast<std::size_t>(cache_.size_class())];
  double waits = 0;
  for (int b = 0; b < kAgeBuckets; ++b) {
    const double age = age_of(b);
    if (age >= window) break;
    waits += static_cast<double>(recent[static_cast<std::size_t>(b)]) / rays_ * (1 - age / window);
  }
  return waits;
}

}  // namespace ctu::ladder
