#include "sim/area/area_json.h"

#include <nlohmann/json.hpp>

namespace ctu::area {
namespace {

using nlohmann::ordered_json;

constexpr int kAreaVersion = 1;

ordered_json to_json(const Area& area) {
  ordered_json memories = ordered_json::array();
  for (const auto& [shape, count] : area.memories)
    memories.push_back({{"words", shape.words},
                        {"width", shape.width},
                        {"read_ports", shape.read_ports},
                        {"write_ports", shape.write_ports},
                        {"count", count}});
  return {{"gates", area.gates},
          {"flip_flops", area.flip_flops},
          {"gate_equivalents", area.gate_equivalents},
          {"memory_bits", area.memory_bits()},
          {"depth", area.depth},
          {"memories", std::move(memories)},
          {"fpga",
           {{"lut4", area.fpga.lut4},
            {"flip_flops", area.fpga.flip_flops},
            {"dsps", area.fpga.dsps},
            {"block_rams", area.fpga.block_rams}}}};
}

}  // namespace

std::string area_json(const AreaReport& report, const std::string& hash, const RtlParameters& parameters) {
  ordered_json json{{"format", "ctusim-area"}, {"version", kAreaVersion}, {"config_hash", hash}};
  for (const auto& [name, value] : parameters) json["parameters"][name] = value;
  json["stages"] = ordered_json::array();
  for (const StageArea& stage : report.stages) {
    ordered_json one{{"stage", stage.module}, {"instances", stage.instances}};
    one.update(to_json(stage.area));
    json["stages"].push_back(std::move(one));
  }
  json["total"] = to_json(report.total);
  json["modules"] = {{"synthesised", report.synthesised}, {"cached", report.cached}};
  return json.dump(2) + "\n";
}

}  // namespace ctu::area
