#include "sim/tailor/search.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/parameter.h"
#include "sim/config_file.h"

namespace ctu::tailor {
namespace {

using cull::Design;
using pipeline::Parameter;
using pipeline::ParameterValue;
using pipeline::UnitConfig;

const Parameter& parameter(const std::string& key) {
  const auto& all = pipeline::parameters();
  return *std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.key == key; });
}

class DimensionList {
 public:
  explicit DimensionList(const UnitConfig& start) : start_(start) {}

  /// Powers of two from `least` up to the start's value, and that.
  void halve(const std::string& key, std::int64_t least) {
    const std::int64_t most = std::get<std::int64_t>(value_of(start_, key));
    Dimension dimension{key, {}};
    for (std::int64_t value = least; value < most; value *= 2) dimension.values.emplace_back(value);
    add(std::move(dimension), most);
  }
  /// These values where they are below the start's, and that; or all, where smaller values are larger units.
  void choose(const std::string& key, std::initializer_list<std::int64_t> values, bool also_above = false) {
    const std::int64_t most = std::get<std::int64_t>(value_of(start_, key));
    Dimension dimension{key, {}};
    for (const std::int64_t value : values)
      if (also_above ? value > most : value < most) dimension.values.emplace_back(value);
    add(std::move(dimension), most);
  }
  void name(const std::string& key, std::initializer_list<const char*> values) {
    Dimension dimension{key, {}};
    const ParameterValue own = value_of(start_, key);
    for (const char* value : values)
      if (ParameterValue(std::string(value)) != own) dimension.values.emplace_back(std::string(value));
    dimension.values.push_back(own);
    all_.push_back(std::move(dimension));
  }
  void cache(const std::string& name, std::initializer_list<std::int64_t> bytes) {
    choose(name + ".bytes", bytes);
    choose(name + ".ways", {1, 2, 4, 8});
    choose(name + ".mshrs", {1, 2, 3, 4, 6, 8, 10, 12, 14, 16, 24, 32});
    choose(name + ".ports", {1, 2, 4});
  }
  std::vector<Dimension> take() { return std::move(all_); }

 private:
  void add(Dimension dimension, std::int64_t own) {
    if (dimension.values.empty()) return;
    dimension.values.emplace_back(own);
    all_.push_back(std::move(dimension));
  }

  const UnitConfig& start_;
  std::vector<Dimension> all_;
};

class Descent {
 public:
  Descent(Workbench& bench, const std::vector<std::uint64_t>& most_cycles, int threads)
      : bench_(bench), most_cycles_(most_cycles), threads_(threads) {}

  bool fast_enough(const UnitConfig& config) {
    const Trial& trial = bench_.run(config);
    if (!trial.ran()) return false;
    for (std::size_t i = 0; i < most_cycles_.size(); ++i)
      if (trial.cycles[i] > most_cycles_[i]) return false;
    return true;
  }

  /// Key after key the smallest value that is fast enough, until none gets smaller.
  UnitConfig from(UnitConfig config, const std::vector<Dimension>& order) {
    for (bool smaller = true; smaller;) {
      smaller = false;
      for (const Dimension& dimension : order) smaller |= shrink(config, dimension);
    }
    return config;
  }

 private:
  /// Takes the smallest of the unit's sizes along one key that is fast enough; true if that is smaller than before.
  bool shrink(UnitConfig& config, const Dimension& dimension) {
    struct Candidate {
      double area;
      UnitConfig config;
    };
    const double before = bench_.area(config);
    std::vector<Candidate> smaller;
    for (const ParameterValue& value : dimension.values) {
      const UnitConfig candidate = with_value(config, dimension.key, value);
      if (!is_consistent(candidate)) continue;
      const double area = bench_.area(candidate);
      if (area < before) smaller.push_back({area, candidate});
    }
    std::sort(smaller.begin(), smaller.end(), [](const auto& a, const auto& b) { return a.area < b.area; });
    // Nearly always the larger is the faster: as many at a time as there are threads, from the smallest on.
    for (std::size_t first = 0; first < smaller.size(); first += static_cast<std::size_t>(threads_)) {
      const std::size_t last = std::min(smaller.size(), first + static_cast<std::size_t>(threads_));
      std::vector<UnitConfig> batch;
      for (std::size_t i = first; i < last; ++i) batch.push_back(smaller[i].config);
      bench_.run_all(batch, threads_);
      for (const UnitConfig& candidate : batch)
        if (fast_enough(candidate)) {
          config = candidate;
          return true;
        }
    }
    return false;
  }

  static bool is_consistent(const UnitConfig& config) {
    try {
      pipeline::check_consistency(config);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  Workbench& bench_;
  const std::vector<std::uint64_t>& most_cycles_;
  int threads_;
};

/// The first order is by what each key can save, the most first; the second the other way; then random ones.
std::vector<Dimension> order_of(std::vector<Dimension> dimensions, int restart, std::uint64_t seed, Workbench& bench,
                                const UnitConfig& config) {
  std::vector<double> saving(dimensions.size());
  for (std::size_t i = 0; i < dimensions.size(); ++i)
    for (const ParameterValue& value : dimensions[i].values)
      saving[i] = std::max(saving[i], bench.area(config) - bench.area(with_value(config, dimensions[i].key, value)));
  std::vector<std::size_t> places(dimensions.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  if (restart < 2)
    std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
      return restart == 0 ? saving[a] > saving[b] : saving[a] < saving[b];
    });
  else
    std::shuffle(places.begin(), places.end(), std::mt19937_64(seed + static_cast<std::uint64_t>(restart)));
  std::vector<Dimension> order;
  for (const std::size_t place : places) order.push_back(std::move(dimensions[place]));
  return order;
}

}  // namespace

ParameterValue value_of(const UnitConfig& config, const std::string& key) { return parameter(key).get(config); }

UnitConfig with_value(const UnitConfig& config, const std::string& key, const ParameterValue& value) {
  UnitConfig changed = config;
  parameter(key).set(changed, value);
  // A batch is never larger than the stack.
  if (key == "stack.entries") changed.stack.spill_batch = std::min(changed.stack.spill_batch, changed.stack.entries);
  return changed;
}

std::vector<Dimension> dimensions_of(const UnitConfig& start, Design design) {
  DimensionList all(start);
  constexpr std::int64_t kKib = 1024;
  const std::initializer_list<std::int64_t> cache_bytes = {0,         kKib,      2 * kKib,  4 * kKib,   8 * kKib,
                                                           16 * kKib, 32 * kKib, 64 * kKib, 128 * kKib, 256 * kKib};
  all.cache("node_cache", cache_bytes);
  all.cache("leaf_cache", cache_bytes);
  all.halve("unit.contexts", 2);
  all.halve("stack.entries", 4);
  all.choose("stack.push_width", {1, 2});
  all.choose("ray_setup.interval", {2, 3, 6}, true);
  all.choose("primitive_cull.units", {1, 2});
  all.choose("packet_cull.packets", {1, 2, 4, 8, 16, 32});
  if (design == Design::Comparators) all.choose("comparators.units", {1, 2, 3});
  const bool has_tables = design != Design::None && design != Design::Comparators;
  if (has_tables) {
    all.choose("cell_locate.units", {1, 2, 3});
    all.name("mask_test.rows", {"all", "folded", "reachable"});
    all.halve("mask_test.banks", 1);
    all.choose("mask_test.ports", {1, 2, 3});
  }
  if (design == Design::Projection) all.choose("mask_test.projection_tables", {1});
  if (start.table_cache.bytes > 0) all.cache("table_cache", cache_bytes);
  return all.take();
}

std::vector<Design> designs_to_try(const Workbench& bench) {
  std::vector<Design> designs;
  for (const Design design :
       {Design::None, Design::Projection, Design::Comparators, Design::MaskLut, Design::Dedup, Design::BitTable})
    if (bench.has_masks_for(design)) designs.push_back(design);
  return designs;
}

SearchResult find_smallest(Workbench& bench, const UnitConfig& start, const SearchOptions& options) {
  const Trial& first = bench.run(start);
  if (!first.ran()) throw Error("the starting configuration", first.refusal, "start from one that runs every trace");
  std::vector<std::uint64_t> most;
  for (std::size_t i = 0; i < first.cycles.size(); ++i) {
    const double ratio = options.ratios.empty() ? 1 + options.slowdown : options.ratios[i];
    most.push_back(static_cast<std::uint64_t>(static_cast<double>(first.cycles[i]) * ratio));
  }
  Descent descent(bench, most, options.threads);
  SearchResult best{start, bench.area(start)};
  const auto keep = [&](const UnitConfig& config) {
    const double area = bench.area(config);
    if (area < best.area) best = {config, area};
  };
  const auto say = [&](const std::string& what) {
    if (options.progress)
      options.progress(fmt::format("{}: {:.4f} mm2 after {} runs", what, best.area * 1e-6, bench.runs()));
  };
  for (const Design design : designs_to_try(bench)) {
    UnitConfig config = start;
    config.mask_test.design = design;
    if (!descent.fast_enough(config)) {
      say(fmt::format("{} alone is too slow", cull::to_string(design)));
      continue;
    }
    keep(descent.from(config, order_of(dimensions_of(start, design), 0, options.seed, bench, config)));
    say(std::string(cull::to_string(design)));
  }
  const Design chosen = best.config.mask_test.design;
  UnitConfig config = start;
  config.mask_test.design = chosen;
  for (int restart = 1; restart < options.restarts && descent.fast_enough(config); ++restart) {
    keep(descent.from(config, order_of(dimensions_of(start, chosen), restart, options.seed, bench, config)));
    say(fmt::format("{}, order {}", cull::to_string(chosen), restart + 1));
  }
  return best;
}

}  // namespace ctu::tailor
