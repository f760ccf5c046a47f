// `ctusim area`: what the RTL of a configuration costs, stage by stage, as yosys synthesises it.
#include <cstdio>

#include <fmt/format.h>

#include "model/base/parallel.h"
#include "sim/area/area_json.h"
#include "sim/area/area_report.h"
#include "sim/area/unit_parameters.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/scene_args.h"

namespace ctu::sim {
namespace {

using area::Area;

/// Cells of a row, in the order of the header.
std::vector<std::string> row_of(const std::string& name, std::uint64_t instances, const Area& area, bool fpga) {
  std::vector<std::string> row = {name,
                                  instances == 0 ? "" : std::to_string(instances),
                                  std::to_string(area.gates),
                                  std::to_string(area.flip_flops),
                                  fmt::format("{:.0f}", area.gate_equivalents),
                                  std::to_string(area.memory_bits()),
                                  std::to_string(area.depth)};
  if (fpga)
    for (const std::uint64_t count : {area.fpga.lut4, area.fpga.flip_flops, area.fpga.dsps, area.fpga.block_rams})
      row.push_back(std::to_string(count));
  return row;
}

void print_cells(const std::vector<std::string>& cells, bool markdown) {
  if (markdown) return fmt::print("| {} |\n", fmt::join(cells, " | "));
  fmt::print("{:<20}", cells.front());
  for (std::size_t i = 1; i < cells.size(); ++i) fmt::print(" {:>17}", cells[i]);
  fmt::print("\n");
}

void print_table(const area::AreaReport& report, bool fpga, bool markdown) {
  std::vector<std::string> header = {"stage",       "instances", "gates", "flip-flops", "gate equivalents",
                                     "memory bits", "depth"};
  if (fpga) header.insert(header.end(), {"LUT4", "FPGA flip-flops", "DSP 18x18", "block RAM 18k"});
  print_cells(header, markdown);
  if (markdown) {
    fmt::print("| --- |");
    for (std::size_t i = 1; i < header.size(); ++i) fmt::print(" ---: |");
    fmt::print("\n");
  }
  for (const area::StageArea& stage : report.stages)
    print_cells(row_of(stage.module, stage.instances, stage.area, fpga), markdown);
  print_cells(row_of("all", 0, report.total, fpga), markdown);
}

void print_memories(const area::AreaReport& report) {
  fmt::print("\nmemories: words x bits, read + write ports\n");
  for (const area::StageArea& stage : report.stages)
    for (const auto& [shape, count] : stage.area.memories)
      fmt::print("{:<20}{:>4} of {} x {}, {} + {}\n", stage.module, count, shape.words, shape.width, shape.read_ports,
                 shape.write_ports);
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    words.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

cull::MaskOptions masks_of(const AreaArgs& args, cull::Design design) {
  cull::MaskOptions masks;
  masks.resolution = args.resolution;
  masks.ray_resolution = args.ray_resolution == 0 ? args.resolution : args.ray_resolution;
  masks.entries = args.entries;
  cull::validate(masks);
  require_possible(design, masks);
  return masks;
}

}  // namespace

int area_command(const AreaArgs& args) {
  const pipeline::UnitConfig config = load_config(args.unit.config_path, args.unit.sets);
  require_box_bits(args.box_bits);
  area::AreaJob job;
  job.rtl = args.rtl.empty() ? CTU_RTL_FOLDER : args.rtl;
  job.parameters =
      area::unit_parameters(config, masks_of(args, config.mask_test.design), job.rtl / (job.top + ".sv"),
                            {args.box_bits, args.primitive_boxes, args.spheres, args.packet_entries, args.trees});
  job.stages = split(args.stages);
  job.fpga = args.fpga;
  job.cache = args.cache;
  job.yosys = args.yosys;
  job.threads = args.threads == 0 ? available_threads() : args.threads;
  job.on_stage = [](const std::string& stage) { fmt::print(stderr, "synthesis: {}\n", stage); };
  const area::AreaReport report = area_of(job);
  if (args.json) {
    fmt::print("{}", area_json(report, config_hash(config), job.parameters));
    return 0;
  }
  print_table(report, args.fpga, args.markdown);
  if (!args.markdown) print_memories(report);
  return 0;
}

}  // namespace ctu::sim
