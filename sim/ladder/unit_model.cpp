#include "sim/ladder/unit_model.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ctu::ladder {
namespace {

/// Demand of a ray on a server: visits, cycles and squared cycles, summed over its visits.
struct Demand {
  double visits = 0, cycles = 0, squared = 0;
  void add(double times, double cycles_each) {
    visits += times;
    cycles += times * cycles_each;
    squared += times * cycles_each * cycles_each;
  }
};

/// Waiting of a ray at a server, summed over its visits, when `rate` rays a cycle come.
double waiting(const Demand& demand, double rate) {
  const double busy = std::min(rate * demand.cycles, 0.9999);
  return demand.visits * rate * demand.squared / (2 * (1 - busy));
}
/// Likewise where at most one token comes a cycle, as behind another stage.
double waiting_spaced(const Demand& demand, double rate) {
  const double busy = std::min(rate * demand.cycles, 0.9999);
  return demand.visits * rate * std::max(0.0, demand.squared - demand.cycles) / (2 * (1 - busy));
}

/// Erlang's loss formula: the share of calls that find `servers` busy when `load` of them would be on average.
double all_busy(int servers, double load) {
  double inverse = 1;
  for (int k = 1; k <= servers; ++k) inverse = 1 + inverse * k / std::max(load, 1e-12);
  return 1 / inverse;
}

/// The memory behind the port, for lines that come at some rate.
class Memory {
 public:
  explicit Memory(const pipeline::MemoryConfig& config) : config_(config) {}

  /// Cycles that one line keeps the part of the memory busy that is the first to be, all parts together being one.
  double demand(double open) const {
    if (config_.model == pipeline::MemoryModel::Ideal) return config_.interval;
    return std::max(bus(), bank(open)) / refreshed();
  }
  /// From the lookup that misses to the line's return, when `lines` come a cycle of which the share `open` finds its
  /// row open.
  double latency(double lines, double open) const {
    constexpr double kLinks = 4;  // request link, port, answer, answer link
    if (config_.model == pipeline::MemoryModel::Ideal)
      return kLinks + config_.latency + queue(lines * config_.interval, config_.interval);
    const double unloaded =
        config_.front_latency + config_.t_cl + config_.burst + (1 - open) * (config_.t_rcd + config_.t_rp);
    const double refresh = config_.t_rfc == 0 ? 0 : 0.5 * config_.t_rfc * config_.t_rfc / config_.t_refi;
    return kLinks + unloaded + refresh + queue(lines * bus() / refreshed(), config_.burst) +
           queue(lines * bank(open) / refreshed(), config_.t_ras + config_.t_rp);
  }

 private:
  static double queue(double busy, double service) {
    busy = std::min(busy, 0.9999);
    return busy * service / (2 * (1 - busy));
  }
  double refreshed() const { return 1 - static_cast<double>(config_.t_rfc) / config_.t_refi; }
  double bus() const { return static_cast<double>(config_.burst) / config_.channels; }
  double bank(double open) const {
    return (1 - open) * (config_.t_ras + config_.t_rp) / (static_cast<double>(config_.channels) * config_.banks);
  }
  const pipeline::MemoryConfig& config_;
};

class PhaseModel {
 public:
  PhaseModel(const Phase& phase, const pipeline::UnitConfig& config, const UnitShape& shape,
             const CacheModel& node_cache, const CacheModel& leaf_cache, const CacheModel& table_cache)
      : phase_(phase),
        config_(config),
        shape_(shape),
        rays_(static_cast<double>(phase.rays)),
        visits_(of(phase.nodes) + of(phase.leaves)),
        memory_(config.memory),
        node_(phase.node, node_cache, rays_),
        leaf_(phase.leaf, leaf_cache, rays_),
        table_(phase.table, table_cache, rays_),
        lines_(node_.demand().lines + leaf_.demand().lines + table_.demand().lines + of(phase.spills + phase.refills)) {
    if (lines_ > 0)
      open_rows_ = (node_.demand().open_rows + leaf_.demand().open_rows + table_.demand().open_rows) / lines_;
    count_node_way();
    count_stack();
    count_leaf_way();
  }

  PhaseEstimate solve() {
    double low = 0, high = 1 / most_demand();
    for (int i = 0; i < 20; ++i) {
      const double rate = 0.5 * (low + high);
      (rate * latency(rate) < config_.unit.contexts ? low : high) = rate;
    }
    PhaseEstimate e;
    e.latency = latency(high);
    e.cycles = 1 / high;
    e.memory_latency = memory_latency_;
    e.node = node_.demand();
    e.leaf = leaf_.demand();
    e.table = table_.demand();
    e.stack_requests = of(phase_.spills + phase_.refills);
    e.open_rows = open_rows_ * lines_;
    e.stages.assign(stages_.begin(), stages_.begin() + stage_count_);
    e.limit = limit(e);
    return e;
  }

 private:
  double of(std::uint64_t count) const { return static_cast<double>(count) / rays_; }

  /// cell_locate and mask_test stand one behind the other: a node is held up by the slower of them.
  void count_node_way() {
    nodes_ = of(phase_.nodes);
    const int units = shape_.comparators ? config_.comparators.units : config_.cell_locate.units;
    for (int lanes = 0; lanes < 5; ++lanes)
      for (int turns = 0; turns <= 12; ++turns) {
        const double nodes = of(phase_.asked_turns[static_cast<std::size_t>(lanes)][static_cast<std::size_t>(turns)]);
        if (nodes == 0) continue;
        const int locates = std::max(1, (lanes + units - 1) / units);
        locate_cycles_ += nodes * locates;
        turns_ += nodes * std::max(1, turns);
        cull_.add(nodes, std::max(locates, turns));
      }
  }

  void count_stack() {
    for (int survivors = 1; survivors <= 4; ++survivors)
      stack_.add(of(phase_.survivors[static_cast<std::size_t>(survivors)]),
                 std::max(1, (survivors - 1 + config_.stack.push_width - 1) / config_.stack.push_width));
    const double pops = of(phase_.survivors[0]) + of(phase_.leaves);
    if (pops > 0) stack_.add(pops, 1 + of(phase_.dropped) / pops);
    stack_.cycles += of(phase_.spills + phase_.refills);
  }

  void count_leaf_way() {
    for (int tests = 1; tests <= kMostPrimitives; ++tests)
      triangles_.add(of(phase_.tests[static_cast<std::size_t>(tests)]), tests * config_.triangle_test.interval);
  }

  /// Demand of the entrance of a fetch stage at `rate` rays a cycle: lookups, a cycle for each line that comes, and the
  /// cycles in which a full set of miss registers holds it up. Of n registers that came to be busy at any time within
  /// one latency the first becomes free after latency / (n + 1) on average; lines that never end keep all busy.
  Demand fetch_demand(const FetchModel& fetch, const pipeline::CacheConfig& cache, double rate) const {
    const FetchDemand& d = fetch.demand();
    Demand demand{d.visits, d.cycles + d.lines, d.squared_cycles};
    if (d.visits > 0) demand.squared += d.lines * (2 * d.cycles / d.visits + 1);
    const double until_free = memory_latency_ / (cache.mshrs + 1);
    double held_up = 0;
    for (int i = 0; i < 4; ++i) {
      const double moving = std::max(0.01, 1 - rate * held_up);
      held_up = d.lines * all_busy(cache.mshrs, rate * d.lines * memory_latency_ / moving) * until_free;
      held_up = std::min(held_up, 0.99 / rate);
    }
    demand.cycles = std::max(demand.cycles + held_up, d.lines * memory_latency_ / cache.mshrs);
    demand.squared += held_up * 2 * until_free;
    return demand;
  }

  /// Of a ray in a fetch stage, from its entrance on.
  double fetch_latency(const FetchModel& fetch, const pipeline::CacheConfig& cache, double rate) const {
    const FetchDemand& d = fetch.demand();
    const double window = std::max(1.0, memory_latency_ * rate * visits_);
    return d.visits + d.cycles + (d.visits - d.missing_visits) * cache.hit_latency +
           (d.missing_visits + fetch.joined(window)) * memory_latency_;
  }

  double most_demand() const {
    const auto fetch = [](const FetchModel& model) { return model.demand().cycles + model.demand().lines; };
    return std::max({visits_, cull_.cycles, turns_, stack_.cycles, triangles_.cycles, of(phase_.triangles),
                     static_cast<double>(config_.ray_setup.interval), static_cast<double>(config_.result.interval),
                     fetch(node_), fetch(leaf_), fetch(table_), lines_ * memory_.demand(open_rows_)});
  }

  void add_stage(const char* name, double cycles, double waits, double stays) {
    stages_[static_cast<std::size_t>(stage_count_++)] = {name, cycles, waits, stays};
  }

  /// Cycles of a ray in its context at `rate` rays a cycle; the stages' loads beside it.
  double latency(double rate) {
    stage_count_ = 0;
    memory_latency_ = memory_.latency(rate * lines_, open_rows_);
    add_stage("ray_queue", config_.ray_setup.interval, 0, config_.ray_setup.interval - 1 + config_.ray_setup.latency);
    add_stage("scheduler", visits_, waiting_spaced({visits_, visits_, 2 * visits_}, rate), 2 * visits_);
    add_fetch("node_fetch", node_, config_.node_cache, rate, 0);
    const int decode = shape_.decodes_boxes ? config_.box_decode.latency : 0;
    add_stage("box_test", nodes_, 0, nodes_ * (1 + config_.box_test.latency + decode));
    if (shape_.mask_test) add_culling(rate);
    add_stage("child_sort", nodes_, 0, nodes_ * (1 + config_.child_sort.latency));
    add_stage("traversal_stack", stack_.cycles, waiting(stack_, rate),
              stack_.visits + stack_.cycles + of(phase_.refills) * memory_latency_);
    add_leaves(rate);
    add_stage("result_queue", config_.result.interval, 0, 3);
    add_stage("memory_port", lines_ * std::max(1.0, memory_.demand(open_rows_)), 0, 0);
    double sum = 0;
    for (int i = 0; i < stage_count_; ++i)
      sum += stages_[static_cast<std::size_t>(i)].waits + stages_[static_cast<std::size_t>(i)].stays;
    return sum;
  }

  void add_fetch(const char* name, const FetchModel& fetch, const pipeline::CacheConfig& cache, double rate,
                 double more) {
    const Demand demand = fetch_demand(fetch, cache, rate);
    add_stage(name, demand.cycles, waiting(demand, rate), fetch_latency(fetch, cache, rate) + more);
  }

  void add_culling(double rate) {
    const int latency = shape_.comparators ? config_.comparators.latency : config_.cell_locate.latency;
    add_stage("cell_locate", locate_cycles_, waiting_spaced(cull_, rate), nodes_ * latency + locate_cycles_);
    if (shape_.table_fetch) {
      const double second_round =
          shape_.reads_twice ? table_.demand().visits * (config_.table_cache.hit_latency + 2) : 0;
      add_fetch("table_fetch", table_, config_.table_cache, rate, nodes_ - table_.demand().visits + second_round);
    }
    const bool second = shape_.reads_twice && !shape_.table_fetch;
    add_stage("mask_test", turns_, 0,
              nodes_ * (config_.mask_test.latency + (second ? config_.mask_test.second_latency : 0)) + turns_);
  }

  void add_leaves(double rate) {
    const double leaves = of(phase_.leaves);
    add_fetch("leaf_fetch", leaf_, config_.leaf_cache, rate, 0);
    if (shape_.primitive_boxes) {
      const double boxes = leaves == 0 ? 0 : of(phase_.leaf_primitives) / leaves;
      Demand cull;
      cull.add(leaves, std::max(1.0, std::ceil(boxes / config_.primitive_cull.units)));
      add_stage("primitive_cull", cull.cycles, waiting_spaced(cull, rate),
                leaves * config_.primitive_cull.latency + cull.cycles);
    }
    add_stage("triangle_test", triangles_.cycles, waiting_spaced(triangles_, rate),
              triangles_.cycles + triangles_.visits * config_.triangle_test.latency);
    const double outcomes = of(phase_.triangles);
    if (shape_.spheres) add_stage("sphere_test", outcomes, 0, triangles_.visits * (1 + config_.sphere_test.latency));
    add_stage("hit_update", outcomes, 0, leaves * (1 + config_.hit_update.latency));
  }

  static const char* limit(const PhaseEstimate& e) {
    const auto most = std::max_element(e.stages.begin(), e.stages.end(),
                                       [](const StageLoad& a, const StageLoad& b) { return a.cycles < b.cycles; });
    return most->cycles > 0.9 * e.cycles ? most->stage : "contexts";
  }

  const Phase& phase_;
  const pipeline::UnitConfig& config_;
  const UnitShape& shape_;
  double rays_, visits_;
  Memory memory_;
  FetchModel node_, leaf_, table_;
  double lines_, open_rows_ = 0;
  Demand cull_, stack_, triangles_;
  double nodes_ = 0, locate_cycles_ = 0, turns_ = 0, memory_latency_ = 0;
  std::array<StageLoad, 17> stages_{};
  int stage_count_ = 0;
};

}  // namespace

UnitModel::UnitModel(const pipeline::UnitConfig& config, const UnitShape& shape)
    : config_(config), shape_(shape), empty_(caches(0, 0, 0)) {}

UnitModel::Caches UnitModel::caches(double nodes, double leaves, double tables) const {
  const auto model = [&](const pipeline::CacheConfig& cache, double width, double lines) {
    return CacheModel(cache, config_.memory, config_.unit.contexts, width, std::min<double>(lines, cache.mshrs));
  };
  return {model(config_.node_cache, shape_.lines_of_node, nodes),
          model(config_.leaf_cache, shape_.lines_of_leaf, leaves),
          model(config_.table_cache, shape_.lines_of_rows, tables)};
}

PhaseEstimate UnitModel::estimate(const Phase& phase) const {
  const auto solve = [&](const Caches& caches) {
    return PhaseModel(phase, config_, shape_, caches.node, caches.leaf, caches.table).solve();
  };
  const PhaseEstimate first = solve(empty_);
  // By Little's law, of lines instead of rays; a ray finds those of the others.
  const double others = 1 - 1.0 / config_.unit.contexts;
  const double each = others * first.memory_latency / first.cycles;
  return solve(caches(each * first.node.lines, each * first.leaf.lines, each * first.table.lines));
}

}  // namespace ctu::ladder
