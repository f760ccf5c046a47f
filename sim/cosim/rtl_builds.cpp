#include "sim/cosim/rtl_builds.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "model/accel/largest_leaf.h"
#include "model/base/error.h"
#include "sim/cosim/table_image.h"

namespace ctu::cosim {
namespace {

constexpr int kMaxHitLatency = 31;  ///< unit_bench.sv
constexpr std::string_view kOtherSources = "was built from other sources than this program";

/// Rows of dedup's second memory.
std::uint64_t distinct_rows(const pipeline::UnitConfig& config, const pipeline::Work& work) {
  const cull::OnChipTables tables(work.tester, config.mask_test.rows, config.mask_test.projection_tables);
  return tables.tables()[1].rows;
}

/// Collects what does not fit.
class Misfits {
 public:
  template <class Value>
  void same(const char* what, const Value& is, const Value& wanted) {
    if (is != wanted) add(fmt::format("{} {} instead of {}", what, is, wanted));
  }
  void at_most(const char* what, int limit, int wanted) {
    if (wanted > limit) add(fmt::format("{} up to {} instead of {}", what, limit, wanted));
  }
  void at_least(const char* what, int limit, int wanted) {
    if (wanted < limit) add(fmt::format("{} from {} on instead of {}", what, limit, wanted));
  }
  const std::string& text() const { return text_; }

 private:
  void add(const std::string& what) { text_ += (text_.empty() ? "" : ", ") + what; }
  std::string text_;
};

void check_cache(Misfits& misfits, const std::string& name, const RtlParameters& build,
                 const pipeline::CacheConfig& cache, int ports) {
  misfits.same((name + ".ports").c_str(), ports, cache.ports);
  if (cache.bytes > 0) {
    misfits.at_most((name + ".ways").c_str(), build.max_ways, cache.ways);
    misfits.at_most(("sets of " + name).c_str(), build.max_sets, cache.bytes / build.line_bytes / cache.ways);
  }
  misfits.at_most((name + ".mshrs").c_str(), build.max_mshrs, cache.mshrs);
  misfits.at_most((name + ".hit_latency").c_str(), kMaxHitLatency, cache.hit_latency);
}

/// What leaves hold, and the stages that only some of it needs.
void check_primitives(Misfits& misfits, const RtlParameters& build, const pipeline::UnitConfig& config,
                      const accel::Image& image) {
  misfits.same("primitive boxes", build.primitive_boxes, image.layout.primitive_boxes);
  if (build.primitive_boxes) {
    misfits.same("primitive_cull.units", build.cull_units, config.primitive_cull.units);
    misfits.same("primitive_cull.latency", build.cull_latency, config.primitive_cull.latency);
  }
  if (image.sphere_count != 0) misfits.same("spheres", build.spheres, true);
  if (build.spheres) {
    misfits.same("spheres", build.spheres, image.sphere_count != 0);
    misfits.same("sphere_test.latency", build.sphere_latency, config.sphere_test.latency);
  }
}

void check_packets(Misfits& misfits, const RtlParameters& build, const pipeline::UnitConfig& config,
                   const reference::PacketPlan& packets) {
  misfits.same("rays in packets", build.packets > 0, packets.any());
  if (build.packets == 0) return;
  misfits.at_most("packet_cull.packets", build.packets, config.packet_cull.packets);
  misfits.at_most("entries of a packet", build.packet_entries, packets.most_entries);
  misfits.at_least("packet_cull.interval", build.packet_interval, config.packet_cull.interval);
  misfits.same("packet_cull.latency", build.packet_latency, config.packet_cull.latency);
}

void check_mask_test(Misfits& misfits, const RtlParameters& build, const pipeline::UnitConfig& config,
                     const pipeline::Work& work) {
  const cull::MaskOptions& masks = work.tester.options();
  misfits.same("R", build.resolution, masks.resolution);
  misfits.same("compressed masks", build.entries > 0, masks.entries > 0);
  misfits.at_most("entries", build.entries, masks.entries);
  const bool comparators = build.design == cull::Design::Comparators;
  if (!comparators) misfits.same("R_ray", build.ray_resolution, masks.ray_resolution);
  if (comparators) {
    misfits.same("comparators.units", build.locate_units, config.comparators.units);
    misfits.same("comparators.latency", build.locate_latency, config.comparators.latency);
  } else {
    misfits.same("cell_locate.units", build.locate_units, config.cell_locate.units);
    misfits.same("cell_locate.latency", build.locate_latency, config.cell_locate.latency);
    misfits.same("mask_test.rows", cull::to_string(build.rows), cull::to_string(config.mask_test.rows));
  }
  if (build.design == cull::Design::Projection)
    misfits.same("mask_test.projection_tables", build.projection_tables, config.mask_test.projection_tables);
  misfits.same("table_cache", build.table_cache, has_table_fetch(config, work));
  if (build.table_cache) {
    check_cache(misfits, "table_cache", build, config.table_cache, build.table_ports);
  } else {
    misfits.same("mask_test.banks", build.banks, config.mask_test.banks);
    misfits.same("mask_test.ports", build.ports, config.mask_test.ports);
  }
  misfits.same("mask_test.latency", build.mask_latency, config.mask_test.latency);
  if (build.design != cull::Design::Dedup) return;
  if (!build.table_cache)
    misfits.same("mask_test.second_latency", build.mask_second_latency, config.mask_test.second_latency);
  misfits.same("distinct ray masks", static_cast<std::uint64_t>(build.distinct), distinct_rows(config, work));
}

std::string library_folder(const std::string& given) {
  if (!given.empty()) return given;
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "rtl").string();
}

/// The library's unit; none when it was built from other sources than this program, whose calls it may not understand.
std::unique_ptr<RtlUnit> load_if_current(const std::string& library) {
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  using Make = RtlUnit* (*)();
  const auto make = handle == nullptr ? nullptr : reinterpret_cast<Make>(dlsym(handle, "ctu_make_rtl_unit"));
  if (make == nullptr) throw Error(library, dlerror(), "build it again: `./dev rtl`");
  const auto* const sources = static_cast<const char*>(dlsym(handle, "ctu_rtl_sources"));
  if (sources == nullptr || sources != std::string_view(CTU_RTL_SOURCES)) return nullptr;
  return std::unique_ptr<RtlUnit>(make());
}

}  // namespace

std::string misfit(const RtlParameters& build, const pipeline::UnitConfig& config, const pipeline::Work& work) {
  Misfits misfits;
  misfits.same("mask_test.design", cull::to_string(build.design), cull::to_string(config.mask_test.design));
  misfits.same("memory.line_bytes", build.line_bytes, config.memory.line_bytes);
  misfits.at_most("unit.contexts", 1 << build.slot_bits, config.unit.contexts);
  misfits.at_most("stack.entries", build.stack_entries, config.stack.entries);
  if (3 * work.image.depth + work.rays.packets().most_entries > config.stack.entries)
    misfits.same("spills", build.has_spills, true);
  misfits.at_least("ray_setup.interval", build.ray_interval, config.ray_setup.interval);
  misfits.same("ray_setup.latency", build.ray_setup_latency, config.ray_setup.latency);
  misfits.same("bits of a coordinate", build.box_bits, work.image.layout.box_bits);
  if (build.box_bits != 32) misfits.same("box_decode.latency", build.decode_latency, config.box_decode.latency);
  misfits.same("box_test.latency", build.box_latency, config.box_test.latency);
  misfits.same("child_sort.latency", build.sort_latency, config.child_sort.latency);
  check_primitives(misfits, build, config, work.image);
  check_packets(misfits, build, config, work.rays.packets());
  misfits.at_most("trees", build.trees, static_cast<int>(work.image.trees()));
  misfits.same("triangle_test.latency", build.triangle_latency, config.triangle_test.latency);
  misfits.same("hit_update.latency", build.hit_latency, config.hit_update.latency);
  check_cache(misfits, "node_cache", build, config.node_cache, build.node_ports);
  check_cache(misfits, "leaf_cache", build, config.leaf_cache, build.leaf_ports);
  if (build.design == config.mask_test.design && build.design != cull::Design::None)
    check_mask_test(misfits, build, config, work);
  // Last, as it looks at every node: a leaf that is larger would be read with the wrong triangles in it.
  if (misfits.text().empty())
    misfits.at_most("bytes of a leaf", build.max_leaf_bytes, static_cast<int>(accel::largest_leaf_bytes(work.image)));
  return misfits.text();
}

pipeline::UnitConfig config_of(const RtlParameters& build) {
  pipeline::UnitConfig config;
  config.mask_test.design = build.design;
  config.mask_test.rows = build.rows;
  config.mask_test.banks = build.banks;
  config.mask_test.ports = build.ports;
  config.mask_test.projection_tables = build.projection_tables;
  config.mask_test.latency = build.mask_latency;
  config.mask_test.second_latency = build.mask_second_latency;
  config.cell_locate.units = config.comparators.units = build.locate_units;
  config.cell_locate.latency = config.comparators.latency = build.locate_latency;
  config.node_cache.ports = build.node_ports;
  config.leaf_cache.ports = build.leaf_ports;
  config.table_cache.ports = build.table_ports;
  config.memory.line_bytes = build.line_bytes;
  config.ray_setup.latency = build.ray_setup_latency;
  config.box_decode.latency = build.decode_latency;
  config.box_test.latency = build.box_latency;
  config.child_sort.latency = build.sort_latency;
  config.primitive_cull.units = build.cull_units;
  config.primitive_cull.latency = build.cull_latency;
  if (build.packets > 0) {
    config.packet_cull = {.packets = build.packets, .latency = build.packet_latency};
    config.packet_cull.interval = std::max(config.packet_cull.interval, build.packet_interval);
  }
  config.triangle_test.latency = build.triangle_latency;
  config.sphere_test.latency = build.sphere_latency;
  config.hit_update.latency = build.hit_latency;
  return config;
}

std::vector<std::string> rtl_libraries(const std::string& folder) {
  std::vector<std::string> libraries;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(library_folder(folder), none))
    if (entry.path().extension() == ".so") libraries.push_back(entry.path().string());
  std::sort(libraries.begin(), libraries.end());
  return libraries;
}

std::unique_ptr<RtlUnit> load_rtl_unit(const std::string& library) {
  std::unique_ptr<RtlUnit> unit = load_if_current(library);
  if (unit == nullptr) throw Error(library, std::string(kOtherSources), "build it again: `./dev rtl`");
  return unit;
}

std::unique_ptr<RtlUnit> make_rtl_unit(const pipeline::UnitConfig& config, const pipeline::Work& work,
                                       const std::string& folder) {
  std::string reasons;
  for (const std::string& library : rtl_libraries(folder)) {
    std::unique_ptr<RtlUnit> unit = load_if_current(library);
    if (unit == nullptr) {
      reasons += fmt::format("\n  {}: {}: `./dev rtl` builds it again", library, kOtherSources);
      continue;
    }
    const std::string reason = misfit(unit->parameters(), config, work);
    if (reason.empty()) return unit;
    reasons += fmt::format("\n  {}: {}", unit->parameters().name, reason);
  }
  if (reasons.empty())
    throw Error(library_folder(folder), "no build of the RTL unit is there",
                "install verilator and build: `./dev rtl`");
  throw Error("--engine", "no build of the RTL unit has this configuration:" + reasons,
              "change the configuration, or add a build to sim/cosim/builds.cmake");
}

}  // namespace ctu::cosim
