#include "sim/ladder/estimate.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "model/pipeline/parameter.h"
#include "model/pipeline/work.h"
#include "sim/ladder/block_sample.h"
#include "sim/ladder/recorded_counts.h"
#include "sim/ladder/unit_model.h"

namespace ctu::ladder {
namespace {

using pipeline::Counter;
using pipeline::UnitResult;

/// The rows of the tables lie one behind the other, all in use, so that all sets of a cache have equally many.
constexpr double kEvenly = 1e9;
constexpr int kProfileVersion = 2;  ///< of what is counted, beside the layout of Phase

UnitShape shape_of(const TraceWork& work, const VisitProfile& profile, const pipeline::UnitConfig& config) {
  const accel::Image& image = work.reader.manifest().image.shape;
  const cull::Design design = config.mask_test.design;
  UnitShape shape;
  shape.decodes_boxes = image.layout.box_bits != accel::kFullBoxBits;
  shape.primitive_boxes = image.layout.primitive_boxes;
  shape.spheres = image.sphere_count != 0;
  shape.mask_test = design != cull::Design::None;
  shape.comparators = design == cull::Design::Comparators;
  shape.reads_twice = design == cull::Design::Dedup;
  shape.table_fetch = config.table_cache.bytes > 0 && !profile.tables.empty();
  Phase counted{};
  for (const Phase& phase : profile.phases) counted += phase;
  const auto width = [](const LineProfile& lines) {
    return lines.visits == 0 ? 1 : static_cast<double>(lines.lookups) / static_cast<double>(lines.visits);
  };
  shape.lines_of_node = width(counted.node);
  shape.lines_of_leaf = width(counted.leaf);
  shape.lines_of_rows = kEvenly;
  return shape;
}

/// The sums of all phases of a profile, for the whole trace.
class Sums {
 public:
  Sums(const VisitProfile& profile, const pipeline::UnitConfig& config, const UnitShape& shape, const TraceWork& work)
      : config_(config), shape_(shape), profile_(profile) {
    const UnitModel model(config, shape);
    std::map<std::string, double> limits;
    for (const Phase& phase : profile.phases) {
      const PhaseEstimate e = model.estimate(phase);
      add(phase, e);
      limits[e.limit] += e.cycles * static_cast<double>(phase.rays);
    }
    limit_ = std::max_element(limits.begin(), limits.end(), [](const auto& a, const auto& b) {
               return a.second < b.second;
             })->first;
    find_scale(work);
    // The last ray comes in at the end of the phases and still has its way to go.
    cycles_ = cycles_ * scale_ + latency_ / static_cast<double>(counted_.rays);
  }

  Estimate result() const {
    Estimate e;
    e.limit = limit_;
    UnitResult& r = e.result;
    r.cycles = static_cast<std::uint64_t>(std::llround(cycles_));
    r.rays = profile_.rays_in_all;
    r.counts = counts();
    for (const StageLoad& load : loads_) r.stages.push_back(account(load));
    r.counters = counters();
    for (const StageLoad& load : loads_)
      r.ray_cycles.push_back({load.stage, "waiting for it, and in it until the next stage takes the ray",
                              scaled(load.waits + load.stays)});
    for (const pipeline::Cause& cause : r.ray_cycles) r.ray_latency_sum += cause.cycles;
    return e;
  }

 private:
  void add(const Phase& phase, const PhaseEstimate& e) {
    const auto rays = static_cast<double>(phase.rays);
    counted_ += phase;
    cycles_ += rays * e.cycles;
    latency_ += rays * e.latency;
    if (loads_.empty())
      for (const StageLoad& stage : e.stages) loads_.push_back({stage.stage, 0, 0, 0});
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      loads_[i].cycles += rays * e.stages[i].cycles;
      loads_[i].waits += rays * e.stages[i].waits;
      loads_[i].stays += rays * e.stages[i].stays;
    }
    node_lines_ += rays * e.node.lines;
    leaf_lines_ += rays * e.leaf.lines;
    table_lines_ += rays * e.table.lines;
    open_rows_ += rays * e.open_rows;
  }

  /// A sample stands for all rays in proportion to their visits where these are known, else to their number.
  void find_scale(const TraceWork& work) {
    scale_ = static_cast<double>(profile_.rays_in_all) / static_cast<double>(counted_.rays);
    recorded_ = recorded_counts(work);
    const std::uint64_t visits = counted_.nodes + counted_.leaves;
    if (recorded_ != nullptr && visits > 0)
      scale_ = static_cast<double>(recorded_->node_visits + recorded_->leaf_visits) / static_cast<double>(visits);
  }

  std::uint64_t scaled(double sum) const { return static_cast<std::uint64_t>(std::llround(sum * scale_)); }
  std::uint64_t scaled(std::uint64_t sum) const { return scaled(static_cast<double>(sum)); }

  reference::Counts counts() const {
    if (recorded_ != nullptr) return *recorded_;
    const reference::Counts counted{.node_visits = counted_.nodes,
                                    .triangle_tests = counted_.triangles,
                                    .boxed_out = counted_.boxed_out,
                                    .leaf_visits = counted_.leaves,
                                    .box_hits = counted_.box_hits,
                                    .culled = counted_.culled,
                                    .uncertain = counted_.uncertain,
                                    .dropped = counted_.dropped};
    return scaled_counts(counted, scale_, profile_.rays_in_all);
  }

  /// Busy as long as the stage's entrance is taken.
  pipeline::StageAccount account(const StageLoad& load) const {
    const auto cycles = static_cast<std::uint64_t>(std::llround(cycles_));
    pipeline::StageAccount account;
    account.stage = load.stage;
    account.busy = std::min(cycles, scaled(load.cycles));
    account.idle = cycles - account.busy;
    return account;
  }

  void add_fetch(std::vector<Counter>& counters, const std::string& stage, const LineProfile& lines,
                 double asked) const {
    const auto add = [&](const char* name, const char* unit, const char* what, std::uint64_t value) {
      counters.push_back({stage + name, unit, what, value});
    };
    const std::uint64_t lookups = scaled(lines.lookups), fills = std::min(lookups, scaled(asked));
    add(".lookups", "lines", "lines looked up", lookups);
    add(".hits", "lines", "lines found in the cache, or under way", lookups - fills);
    add(".fills", "lines", "lines that came from memory", fills);
    add(".bytes", "bytes", "bytes that visits asked for", scaled(lines.bytes));
  }

  std::vector<Counter> counters() const {
    std::vector<Counter> list;
    const auto add = [&](std::string name, const char* unit, const char* what, std::uint64_t value) {
      list.push_back({std::move(name), unit, what, value});
    };
    add("estimate.profiled_rays", "rays", "rays whose visits were counted", counted_.rays);
    add("contexts.occupied_cycles", "context cycles", "sum over cycles of occupied contexts", scaled(latency_));
    add_fetch(list, "node_fetch", counted_.node, node_lines_);
    add_fetch(list, "leaf_fetch", counted_.leaf, leaf_lines_);
    add("memory.node_requests", "lines", "lines read for nodes", scaled(node_lines_));
    add("memory.leaf_requests", "lines", "lines read for leaves", scaled(leaf_lines_));
    add("memory.stack_requests", "lines", "lines written and read for spilled stack entries",
        scaled(counted_.spills + counted_.refills));
    add_memory(list);
    if (shape_.table_fetch) {
      add_fetch(list, "table_fetch", counted_.table, table_lines_);
      add("memory.table_requests", "lines", "lines read for table rows", scaled(table_lines_));
    }
    if (shape_.primitive_boxes) {
      add("primitive_cull.boxes", "boxes", "boxes of primitives held against a ray's",
          scaled(counted_.leaf_primitives));
      add("primitive_cull.culled", "primitives", "primitives whose box was not met, not tested",
          scaled(counted_.boxed_out));
    }
    if (shape_.mask_test) add_tables(list);
    add("stack.pushes", "entries", "entries pushed (the nearest child goes straight on)", scaled(counted_.pushes));
    add("stack.pops", "entries", "entries popped, dropped ones included", scaled(counted_.pops));
    add("stack.deepest", "entries", "most entries of one ray", counted_.deepest);
    add("stack.spills", "batches", "batches written to memory", scaled(counted_.spills));
    add("stack.refills", "batches", "batches read back from memory", scaled(counted_.refills));
    return list;
  }

  void add_memory(std::vector<Counter>& list) const {
    if (config_.memory.model != pipeline::MemoryModel::Banked) return;
    const std::uint64_t reads =
        scaled(node_lines_ + leaf_lines_ + table_lines_ + static_cast<double>(counted_.refills));
    const std::uint64_t writes = scaled(counted_.spills);
    const auto add = [&](const char* name, const char* unit, const char* what, std::uint64_t value) {
      list.push_back({name, unit, what, value});
    };
    add("memory.reads", "lines", "lines read", reads);
    add("memory.writes", "lines", "lines written", writes);
    add("memory.row_hits", "lines", "accesses to a row already open", scaled(open_rows_));
    if (config_.memory.t_rfc > 0)
      add("memory.refreshes", "refreshes", "refreshes, summed over channels",
          static_cast<std::uint64_t>(cycles_ / config_.memory.t_refi) *
              static_cast<std::uint64_t>(config_.memory.channels));
    add("memory.bus_cycles", "cycles", "cycles of data on the buses, summed over channels",
        (reads + writes) * static_cast<std::uint64_t>(config_.memory.burst));
  }

  void add_tables(std::vector<Counter>& list) const {
    const auto add = [&](std::string name, const char* unit, const char* what, std::uint64_t value) {
      list.push_back({std::move(name), unit, what, value});
    };
    std::uint64_t lanes = 0;
    for (std::size_t asked = 1; asked < counted_.asked_turns.size(); ++asked)
      for (const std::uint64_t nodes : counted_.asked_turns[asked]) lanes += asked * nodes;
    add("cell_locate.lanes", "lanes", "lanes located", scaled(lanes));
    add("mask_test.lanes_unasked", "lanes", "lanes hit that passed unasked, their object masks being full",
        scaled(counted_.lanes_unasked));
    std::uint64_t reads = 0, shared = 0, bits = 0, rows = 0, used = 0;
    for (const TableUse& table : profile_.tables) {
      reads += table.reads;
      shared += table.shared_reads;
      bits += table.rows * table.row_bits;
      rows += table.rows;
      used += table.rows_used;
    }
    add("mask_test.reads", "reads", "table reads, those of one row in one cycle once", scaled(reads));
    add("mask_test.shared_reads", "reads", "reads saved because another lane read the same row", scaled(shared));
    add("mask_test.table_bits", "bits", "all tables", bits);
    add("mask_test.on_chip_bits", "bits",
        shape_.table_fetch ? "data of table_cache; the tables lie in memory" : "all tables",
        shape_.table_fetch ? static_cast<std::uint64_t>(config_.table_cache.bytes) * 8 : bits);
    add("mask_test.rows", "rows", "rows of all tables", rows);
    add("mask_test.rows_used", "rows", "rows read at least once", used);
    for (const TableUse& table : profile_.tables) {
      std::string name = "mask_test." + table.name;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
      add(name + ".rows", "rows", "rows of this table", table.rows);
      add(name + ".row_bits", "bits", "bits of a row", table.row_bits);
      add(name + ".bits", "bits", "rows * row_bits", table.rows * table.row_bits);
      add(name + ".reads", "reads", "reads of it", scaled(table.reads));
      add(name + ".rows_used", "rows", "rows that the profiled rays read", table.rows_used);
    }
  }

  const pipeline::UnitConfig& config_;
  const UnitShape& shape_;
  const VisitProfile& profile_;
  const reference::Counts* recorded_ = nullptr;
  Phase counted_{};
  double scale_ = 1, cycles_ = 0, latency_ = 0;
  double node_lines_ = 0, leaf_lines_ = 0, table_lines_ = 0, open_rows_ = 0;
  std::vector<StageLoad> loads_;
  std::string limit_;
};

}  // namespace

std::string profile_name(const TraceWork& work, const pipeline::UnitConfig& config) {
  return fmt::format("{} {} rays {} {} {} of {} {}", kProfileVersion, work.reader.hash(), work.range.first,
                     std::min(work.range.last, work.reader.rays()), kProfiledRays, kPhases, profile_key(config));
}

VisitProfile profile_of(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config) {
  BlockSample feed(work, kProfiledRays);
  pipeline::check_consistency(config);
  pipeline::check_fits(config, {image, work.tester, feed});
  VisitProfile profile = count_visits(image, work.tester, config, feed);
  profile.rays_in_all = std::min(work.range.last, work.reader.rays()) - work.range.first;
  return profile;
}

Estimate estimate(const TraceWork& work, const VisitProfile& profile, const pipeline::UnitConfig& config) {
  pipeline::check_consistency(config);
  const UnitShape shape = shape_of(work, profile, config);
  return Sums(profile, config, shape, work).result();
}

}  // namespace ctu::ladder
