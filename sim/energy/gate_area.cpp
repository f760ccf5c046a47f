#include "sim/energy/gate_area.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "sim/energy/on_chip_bits.h"
#include "sim/energy/unit_shape.h"

namespace ctu::energy {
namespace {

constexpr const char* kFit = "fit ";

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The parameters of a stage's row that a table's stages differ in.
std::string mask_test_key(const UnitShape& shape) {
  const auto& test = shape.config.mask_test;
  const std::string design(cull::to_string(test.design));
  if (shape.compares()) return fmt::format("design={} r={} entries={}", design, shape.resolution, shape.entries);
  return fmt::format("design={} r={} r_ray={} entries={} rows={} banks={} ports={}", design, shape.resolution,
                     shape.ray_resolution, shape.entries, cull::to_string(test.rows), test.banks, test.ports);
}

std::string cell_locate_key(const UnitShape& shape) {
  return shape.compares() ? fmt::format("comparators r={} units={}", shape.resolution, shape.config.comparators.units)
                          : fmt::format("keys r={} units={}", shape.ray_resolution, shape.config.cell_locate.units);
}

/// The tabled interval with as many dividers: six divisions a ray, one each cycle on each.
int dividers_as_at(int interval) { return interval >= 6 ? 6 : std::min(interval, 3); }

/// How many characters two texts share at their begin.
std::size_t shared_begin(const std::string& a, const std::string& b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

/// Stages whose latency is not the default one, which the rows are for.
std::vector<std::string> other_latencies(const UnitShape& shape) {
  const pipeline::UnitConfig defaults;
  const pipeline::UnitConfig& config = shape.config;
  std::vector<std::string> stages;
  const auto check = [&](const char* stage, bool there, int latency, int usual) {
    if (there && latency != usual) stages.push_back(stage);
  };
  check("ray_queue", true, config.ray_setup.latency, defaults.ray_setup.latency);
  check("box_test", true, config.box_test.latency, defaults.box_test.latency);
  check("box_test", shape.box_bits != 32, config.box_decode.latency, defaults.box_decode.latency);
  check("cell_locate", shape.culls() && !shape.compares(), config.cell_locate.latency, defaults.cell_locate.latency);
  check("cell_locate", shape.compares(), config.comparators.latency, defaults.comparators.latency);
  check("mask_test", shape.culls(), config.mask_test.latency, defaults.mask_test.latency);
  check("mask_test", config.mask_test.design == cull::Design::Dedup, config.mask_test.second_latency,
        defaults.mask_test.second_latency);
  check("child_sort", true, config.child_sort.latency, defaults.child_sort.latency);
  check("primitive_cull", shape.primitive_boxes, config.primitive_cull.latency, defaults.primitive_cull.latency);
  check("triangle_test", true, config.triangle_test.latency, defaults.triangle_test.latency);
  check("sphere_test", shape.spheres, config.sphere_test.latency, defaults.sphere_test.latency);
  check("hit_update", true, config.hit_update.latency, defaults.hit_update.latency);
  return stages;
}

}  // namespace

GateTable::GateTable(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);  // names of the columns
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() < 3) continue;
    if (cells[0] == "check") {
      if (cells[1].empty()) link_bit_ = std::stod(cells[4]) / std::stod(cells[5]);
    } else if (cells[0].starts_with(kFit)) {
      for (std::size_t i = 2; i < cells.size() && !cells[i].starts_with("worst"); ++i)
        coefficients_[cells[0].substr(std::string(kFit).size())].push_back(std::stod(cells[i]));
    } else {
      rows_[cells[0]][cells[1]] = std::stod(cells[2]);
    }
  }
}

const GateTable& GateTable::standard() {
  static const GateTable table{std::string(gate_area_text())};
  return table;
}

double GateTable::stage(const std::string& stage, const std::string& parameters, bool& known) const {
  const auto rows = rows_.find(stage);
  if (rows == rows_.end()) {
    known = false;
    return 0;
  }
  const auto found = rows->second.find(parameters);
  if (found != rows->second.end()) return found->second;
  known = false;
  return std::max_element(rows->second.begin(), rows->second.end(),
                          [&](const auto& a, const auto& b) {
                            return shared_begin(a.first, parameters) < shared_begin(b.first, parameters);
                          })
      ->second;
}

double GateTable::fitted(const std::string& stage, const std::vector<double>& terms) const {
  const auto found = coefficients_.find(stage);
  double sum = 0;
  if (found != coefficients_.end())
    for (std::size_t i = 0; i < std::min(terms.size(), found->second.size()); ++i) sum += terms[i] * found->second[i];
  return sum;
}

GateArea GateTable::of(const UnitShape& shape) const {
  GateArea area;
  area.unknown = other_latencies(shape);
  const auto add = [&](const std::string& name, const std::string& parameters) {
    bool known = true;
    area.gate_equivalents += stage(name, parameters, known);
    if (!known) area.unknown.push_back(name);
  };
  const double contexts = std::exp2(slot_bits(shape));  // as they are built
  const auto add_fetch = [&](const std::string& name, const pipeline::CacheConfig& cache) {
    const double ways = cache.bytes == 0 ? 1 : cache.ways, mshrs = cache.mshrs;
    const double sets = cache.bytes == 0 ? 1 : cache.bytes / shape.config.memory.line_bytes / cache.ways;
    area.gate_equivalents += fitted(name, {1, contexts, mshrs, contexts * mshrs, ways, sets});
    if (cache.ports != 1 || shape.config.memory.line_bytes != 128) area.unknown.push_back(name);
  };
  add("ray_queue", fmt::format("interval={}", dividers_as_at(shape.config.ray_setup.interval)));
  add("box_test", fmt::format("inner={} bits={}", shape.culls() ? 1 : 0, shape.box_bits));
  if (shape.culls()) {
    add("cell_locate", cell_locate_key(shape));
    add("mask_test", mask_test_key(shape));
  }
  for (const char* name : {"child_sort", "triangle_test", "hit_update", "result_queue"}) add(name, "");
  if (shape.spheres) add("sphere_test", "");
  if (shape.primitive_boxes) add("primitive_cull", fmt::format("units={}", shape.config.primitive_cull.units));
  add_fetch("node_fetch", shape.config.node_cache);
  add_fetch("leaf_fetch", shape.config.leaf_cache);
  area.gate_equivalents += fitted("scheduler", {1, contexts});
  area.gate_equivalents += fitted("traversal_stack", {1, contexts, static_cast<double>(shape.config.stack.entries)});
  for (const char* name : {"node_fetch", "leaf_fetch", "scheduler", "traversal_stack"})
    if (!coefficients_.contains(name)) area.unknown.push_back(name);
  if (link_bit_ == 0) area.unknown.push_back("link");
  for (const LinkBits& link : links_of(shape)) area.gate_equivalents += 2 * (link.bits + 1) * link_bit_;
  if (shape.fetches_tables()) area.unknown.push_back("table_fetch");
  if (shape.packet_rays > 0) area.unknown.push_back("packet_cull");
  return area;
}

}  // namespace ctu::energy
