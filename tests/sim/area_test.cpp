// The area of RTL: paths through netlists, netlists of yosys, a small unit from its sources, and what is refused.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/area/area_cache.h"
#include "sim/area/area_report.h"
#include "sim/area/netlist.h"
#include "sim/area/path_graph.h"
#include "sim/area/unit_parameters.h"
#include "tests/sim/program.h"

namespace ctu::area {
namespace {

using test::ScratchFolder;
using test::write_text;

std::string problem_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(PathGraph, LongestPathsGoBetweenPortsAndRegisters) {
  // in a (net 2) -> 3 gates -> register; register (net 6) -> 2 gates -> out b (net 8); in a -> 1 gate -> out c.
  PathGraph graph;
  graph.add_input("a", {2});
  graph.add_logic({2}, {3}, 1);
  graph.add_logic({3, 6}, {4}, 1);
  graph.add_logic({4, 2}, {5}, 1);
  graph.add_capture({5}, 0);
  graph.add_launch({6}, 0);
  graph.add_logic({6}, {7}, 1);
  graph.add_logic({7}, {8}, 1);
  graph.add_output("b", {8});
  graph.add_output("c", {3});
  const PortPaths paths = graph.longest_paths();
  EXPECT_EQ(paths.inside, 2);  // 6 -> 4 -> 5
  EXPECT_EQ(paths.capture, (std::map<std::string, int>{{"a", 3}}));
  EXPECT_EQ(paths.launch, (std::map<std::string, int>{{"b", 2}}));
  EXPECT_EQ(paths.pass, (std::map<std::pair<std::string, std::string>, int>{{{"a", "c"}, 1}}));
  EXPECT_EQ(paths.longest(), 3);
  EXPECT_FALSE(paths.has_loops);
}

TEST(PathGraph, PathsGoThroughModulesInside) {
  PortPaths inner;
  inner.capture["d"] = 4;
  inner.launch["q"] = 5;
  inner.pass[{"d", "y"}] = 7;
  PathGraph graph;
  graph.add_input("a", {2});
  graph.add_logic({2}, {3}, 1);
  graph.add_module(inner, {{"d", {3}}, {"q", {4}}, {"y", {5}}});
  graph.add_logic({4, 5}, {6}, 1);
  graph.add_output("z", {6});
  const PortPaths paths = graph.longest_paths(11);
  EXPECT_EQ(paths.inside, 11);
  EXPECT_EQ(paths.capture.at("a"), 5);
  EXPECT_EQ(paths.launch.at("z"), 6);
  EXPECT_EQ((paths.pass.at({"a", "z"})), 9);
}

TEST(PathGraph, ALoopThroughAPortIsCut) {
  PathGraph graph;
  graph.add_input("a", {2});
  graph.add_logic({2, 4}, {3}, 1);
  graph.add_logic({3}, {4}, 1);
  graph.add_output("z", {4});
  const PortPaths paths = graph.longest_paths();
  EXPECT_TRUE(paths.has_loops);
  EXPECT_EQ((paths.pass.at({"a", "z"})), 2);
}

// As yosys writes it: a register behind an XOR, an asynchronous read of 4 words of 2 bits, a module that is elsewhere.
constexpr const char* kNetlist = R"({"modules": {
  "inner": {"attributes": {"blackbox": "1"}, "ports": {}, "cells": {}},
  "m": {"attributes": {}, "ports": {
      "clk": {"direction": "input", "bits": [2]}, "a": {"direction": "input", "bits": [3, 4]},
      "y": {"direction": "output", "bits": [5]}, "r": {"direction": "output", "bits": [7, "0"]}},
    "cells": {
      "x": {"type": "$_XOR_", "parameters": {}, "port_directions": {"A": "input", "B": "input", "Y": "output"},
            "connections": {"A": [3], "B": [4], "Y": [6]}},
      "f": {"type": "$_SDFFE_PP0P_", "parameters": {},
            "port_directions": {"C": "input", "D": "input", "E": "input", "Q": "output", "R": "input"},
            "connections": {"C": [2], "D": [6], "E": ["1"], "R": ["0"], "Q": [5]}},
      "i": {"type": "inner", "parameters": {}, "port_directions": {}, "connections": {"p": [6]}},
      "t": {"type": "$mem_v2", "parameters": {"SIZE": "100", "WIDTH": "10", "ABITS": "10", "RD_PORTS": "1",
                                              "WR_PORTS": "0", "RD_CLK_ENABLE": "0"},
            "connections": {"RD_ADDR": [3, 4], "RD_DATA": [7, 8], "RD_EN": ["1"], "RD_ARST": ["0"], "RD_SRST": ["0"],
                            "WR_ADDR": [], "WR_DATA": [], "WR_EN": []}}}}}})";

TEST(Netlist, CountsCellsMemoriesAndModulesAndMeasuresPaths) {
  PortPaths inner;
  inner.inside = 2;
  inner.capture["p"] = 3;
  const auto areas = read_netlist(kNetlist, Target::Gates,
                                  [&](const std::string& module) { return module == "inner" ? &inner : nullptr; });
  ASSERT_EQ(areas.size(), 1U);
  const ModuleArea& area = areas.at("m");
  EXPECT_EQ(area.cells, (std::map<std::string, std::uint64_t>{{"$_SDFFE_PP0P_", 1}, {"$_XOR_", 1}}));
  EXPECT_EQ(area.memories, (std::map<MemoryShape, std::uint64_t>{{{4, 2, 1, 0}, 1}}));
  EXPECT_EQ(area.instances, (std::map<std::string, std::uint64_t>{{"inner", 1}}));
  EXPECT_EQ(area.paths.capture.at("a"), 4);
  EXPECT_EQ((area.paths.pass.at({"a", "r"})), 1);
  EXPECT_EQ(area.paths.launch, (std::map<std::string, int>{{"r", 1}, {"y", 0}}));
  EXPECT_EQ(area.paths.inside, 2);

  const ScratchFolder folder;
  const AreaCache cache(folder.path() / "cache");
  EXPECT_FALSE(cache.find("m"));
  cache.keep("m", area);
  EXPECT_EQ(cache.find("m"), area);
  write_text(folder.path() / "cache" / "m.json", "half a fi");
  EXPECT_FALSE(cache.find("m"));
}

TEST(Netlist, ACellThatIsNoGateIsRefused) {
  const PortPaths inner;
  std::string latch = kNetlist;
  latch.replace(latch.find("$_XOR_"), 6, "$_DLATCH_P_");
  EXPECT_NE(problem_of([&] {
              read_netlist(latch, Target::Gates,
                           [&](const std::string& module) { return module == "inner" ? &inner : nullptr; });
            }).find("$_DLATCH_P_ in m"),
            std::string::npos);
}

TEST(GateEquivalents, EnableAndResetCostMore) {
  EXPECT_EQ(centigates("$_NAND_"), 100);
  EXPECT_LT(centigates("$_DFF_P_"), centigates("$_SDFF_PP0_"));
  EXPECT_LT(centigates("$_SDFF_PP0_"), centigates("$_DFFE_PP_"));
  EXPECT_LT(centigates("$_DFFE_PP_"), centigates("$_SDFFE_PP0P_"));
  EXPECT_LT(centigates("$add"), 0);
  EXPECT_FALSE(is_flip_flop("$_MUX_"));
}

/// Two stages: parity of WIDTH bits behind registers, twice, and a memory.
void write_small_unit(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "inner");
  write_text(folder / "small.sv", R"(
module small #(parameter int WIDTH = 8) (input logic clk_i, input logic [WIDTH-1:0] a_i, input logic [3:0] place_i,
                                         output logic [1:0] y_o, output logic [WIDTH-1:0] d_o);
  parity #(.WIDTH(WIDTH)) first (.clk_i, .a_i, .y_o(y_o[0]));
  parity #(.WIDTH(WIDTH)) second (.clk_i, .a_i(~a_i), .y_o(y_o[1]));
  store #(.WIDTH(WIDTH)) rows (.clk_i, .place_i, .d_i(a_i), .d_o);
endmodule
)");
  write_text(folder / "inner" / "parity.sv", R"(
module parity #(parameter int WIDTH = 8) (input logic clk_i, input logic [WIDTH-1:0] a_i, output logic y_o);
  logic [WIDTH-1:0] a_q;
  always_ff @(posedge clk_i) a_q <= a_i;
  assign y_o = ^a_q;
endmodule
)");
  write_text(folder / "inner" / "store.sv", R"(
module store #(parameter int WIDTH = 8) (input logic clk_i, input logic [3:0] place_i, input logic [WIDTH-1:0] d_i,
                                         output logic [WIDTH-1:0] d_o);
  logic [WIDTH-1:0] rows[16];
  always_ff @(posedge clk_i) rows[place_i] <= d_i;
  assign d_o = rows[place_i];
endmodule
)");
}

class SmallUnit : public testing::Test {
 protected:
  SmallUnit() {
    write_small_unit(folder_.path() / "rtl");
    job_.rtl = folder_.path() / "rtl";
    job_.top = "small";
    job_.cache = folder_.path() / "cache";
    job_.threads = 2;
    job_.yosys = CTU_YOSYS_PROGRAM;
  }

  ScratchFolder folder_;
  AreaJob job_;
};

TEST_F(SmallUnit, EveryInstanceCountsAndMemoriesStayWhole) {
  job_.parameters = {{"WIDTH", 16}};
  const AreaReport report = area_of(job_);
  ASSERT_EQ(report.stages.size(), 2U);
  const StageArea &parity = report.stages[0], &store = report.stages[1];
  EXPECT_EQ(parity.module, "parity");
  EXPECT_EQ(parity.instances, 2U);
  EXPECT_EQ(parity.area.flip_flops, 2U * 16);
  EXPECT_EQ(parity.area.gates, 2U * 15);  // two-input XORs
  EXPECT_DOUBLE_EQ(parity.area.gate_equivalents, 2 * (15 * 2.0 + 16 * 5.67));
  EXPECT_EQ(parity.area.depth, 4);
  EXPECT_EQ(parity.area.memory_bits(), 0U);
  EXPECT_EQ(store.area.flip_flops, 0U);
  EXPECT_EQ(store.area.memories, (std::map<MemoryShape, std::uint64_t>{{{16, 16, 1, 1}, 1}}));
  EXPECT_EQ(report.total.flip_flops, 2U * 16);
  EXPECT_EQ(report.total.gates, 2U * 15 + 16);  // the inverters between the stages
  EXPECT_EQ(report.total.memory_bits(), 256U);
  EXPECT_EQ(report.total.depth, 4);
  EXPECT_EQ(report.synthesised, 3U);
  EXPECT_EQ(report.cached, 0U);
}

TEST_F(SmallUnit, WhatWasSynthesisedIsNotSynthesisedAgain) {
  const AreaReport first = area_of(job_), again = area_of(job_);
  EXPECT_EQ(again.synthesised, 0U);
  EXPECT_EQ(again.cached, 3U);
  ASSERT_EQ(again.stages.size(), first.stages.size());
  EXPECT_EQ(again.total.gate_equivalents, first.total.gate_equivalents);
  EXPECT_EQ(again.total.depth, first.total.depth);
  // A source that the unit does not have changes nothing, a module that is inside others changes these.
  write_text(job_.rtl / "another.sv",
             "module another (input logic a_i, output logic y_o); assign y_o = !a_i; endmodule\n");
  EXPECT_EQ(area_of(job_).synthesised, 0U);
  write_text(job_.rtl / "inner" / "store.sv", test::read_text(job_.rtl / "inner" / "store.sv") + "// end\n");
  EXPECT_EQ(area_of(job_).synthesised, 0U);
  std::string parity = test::read_text(job_.rtl / "inner" / "parity.sv");
  write_text(job_.rtl / "inner" / "parity.sv", parity.replace(parity.find("= ^"), 3, "= &"));
  EXPECT_EQ(area_of(job_).synthesised, 2U);
  // Another width changes all of them.
  job_.parameters = {{"WIDTH", 5}};
  EXPECT_EQ(area_of(job_).synthesised, 3U);
}

TEST_F(SmallUnit, OneStageByItself) {
  job_.stages = {"store"};
  const AreaReport report = area_of(job_);
  ASSERT_EQ(report.stages.size(), 1U);
  EXPECT_EQ(report.stages[0].module, "store");
  EXPECT_EQ(report.synthesised, 1U);
  job_.stages = {"stairs"};
  EXPECT_NE(problem_of([&] { area_of(job_); }).find("no stage stairs"), std::string::npos);
}

TEST_F(SmallUnit, LookUpTablesOfTheFpga) {
  job_.stages = {"parity"};
  job_.fpga = true;
  const AreaReport report = area_of(job_);
  EXPECT_EQ(report.total.fpga.flip_flops, 2U * 8);
  EXPECT_EQ(report.total.fpga.lut4, 2U * 3);  // eight bits: two of four, and one that joins them
  EXPECT_EQ(report.total.fpga.dsps, 0U);
}

TEST_F(SmallUnit, MistakesAreSaid) {
  job_.parameters = {{"DEPTH", 3}};
  EXPECT_NE(problem_of([&] { area_of(job_); }).find("DEPTH"), std::string::npos);
  job_.parameters.clear();
  job_.yosys = "no-such-yosys";
  EXPECT_NE(problem_of([&] { area_of(job_); }).find("no-such-yosys: yosys is not there"), std::string::npos);
  job_.yosys = CTU_YOSYS_PROGRAM;
  job_.rtl = folder_.path() / "nowhere";
  EXPECT_NE(problem_of([&] { area_of(job_); }).find("small.sv is not there"), std::string::npos);
}

TEST(UnitParameters, OfTheConfigurationAndWhatTheRtlHasNot) {
  const ScratchFolder folder;
  const auto top = folder.path() / "ctu_unit.sv";
  write_text(top, "module ctu_unit #(parameter int DESIGN = 0) (); endmodule\n");
  pipeline::UnitConfig config;
  const cull::MaskOptions masks;
  const auto value = [&](const char* name) {
    for (const auto& [parameter, set] : unit_parameters(config, masks, top))
      if (parameter == name) return set;
    return std::int64_t{-1};
  };
  EXPECT_EQ(value("DESIGN"), 5);
  EXPECT_EQ(value("SLOT_BITS"), 5);
  EXPECT_EQ(value("MAX_SETS"), 65536 / 128 / 4);
  EXPECT_EQ(value("DISTINCT"), -1);
  config.mask_test.design = cull::Design::Dedup;
  config.unit.contexts = 33;
  config.stack.entries = 24;
  config.leaf_cache.bytes *= 2;
  EXPECT_EQ(value("DISTINCT"), 1270);
  EXPECT_EQ(value("SLOT_BITS"), 6);
  EXPECT_EQ(value("STACK_ENTRIES"), 32);
  EXPECT_EQ(value("MAX_SETS"), 2 * 65536 / 128 / 4);

  const auto refused = [&] { return problem_of([&] { unit_parameters(config, masks, top); }); };
  config.table_cache.bytes = 4096;
  EXPECT_NE(refused().find("table_cache.bytes: the RTL does not have it"), std::string::npos);
  write_text(top, "module ctu_unit #(parameter int TABLE_CACHE = 0) (); endmodule\n");
  EXPECT_EQ(value("TABLE_CACHE"), 1);
  config.mask_test.design = cull::Design::Ideal;
  EXPECT_NE(refused().find("software only"), std::string::npos);
}

TEST(UnitParameters, OfRaysInPacketsOnlyWhereTheyTravelSo) {
  const ScratchFolder folder;
  const auto top = folder.path() / "ctu_unit.sv";
  write_text(top, "module ctu_unit #(parameter int PACKETS = 0) (); endmodule\n");
  pipeline::UnitConfig config;
  config.packet_cull = {.packets = 5, .latency = 9, .interval = 2};
  const auto value = [&](int entries, const char* name) {
    for (const auto& [parameter, set] : unit_parameters(config, {}, top, {.packet_entries = entries}))
      if (parameter == name) return set;
    return std::int64_t{-1};
  };
  EXPECT_EQ(value(0, "PACKETS"), 0);
  EXPECT_EQ(value(0, "PACKET_ENTRIES"), -1);
  EXPECT_EQ(value(7, "PACKETS"), 5);
  EXPECT_EQ(value(7, "PACKET_ENTRIES"), 7);
  EXPECT_EQ(value(7, "PACKET_LATENCY"), 9);
  EXPECT_EQ(value(7, "MIN_PACKET_INTERVAL"), 2);
  for (const int entries : {-1, 17})
    EXPECT_NE(problem_of([&] { value(entries, "PACKETS"); }).find("--packet-entries"), std::string::npos);
}

TEST(UnitParameters, HaveATableOfRootsOnlyForSeveralTrees) {
  const ScratchFolder folder;
  const auto top = folder.path() / "ctu_unit.sv";
  write_text(top, "module ctu_unit #(parameter int TREES = 1) (); endmodule\n");
  const auto trees = [&](int count) {
    for (const auto& [parameter, set] : unit_parameters({}, {}, top, {.trees = count}))
      if (parameter == "TREES") return set;
    return std::int64_t{-1};
  };
  EXPECT_EQ(trees(1), 1);
  EXPECT_EQ(trees(9), 9);
  for (const int count : {0, 257}) EXPECT_NE(problem_of([&] { trees(count); }).find("--trees"), std::string::npos);
}

/// The program, on a unit with the parameters of the real one and a single stage.
TEST(AreaCommand, PrintsTablesAndJsonAndRefusesWithCodeTwo) {
  const ScratchFolder folder;
  std::string parameters;
  for (const auto& [name, value] : unit_parameters({}, {}, folder.path() / "none.sv"))
    parameters += fmt::format("{}parameter int {} = 0", parameters.empty() ? "" : ", ", name);
  write_text(folder.path() / "ctu_unit.sv",
             fmt::format("module ctu_unit #({}) (input logic clk_i, input logic [R-1:0] a_i, output logic y_o);\n"
                         "  any_bit #(.R(R)) stage (.clk_i, .a_i, .y_o);\nendmodule\n"
                         "module any_bit #(parameter int R = 1) (input logic clk_i, input logic [R-1:0] a_i, "
                         "output logic y_o);\n  always_ff @(posedge clk_i) y_o <= |a_i;\nendmodule\n",
                         parameters));
  const std::string options = "area --rtl . --cache cache --yosys '" CTU_YOSYS_PROGRAM "'";
  const test::Outcome table = test::run_program(folder.path(), options + " --r 3");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_NE(table.out.find("any_bit"), std::string::npos) << table.out;
  const test::Outcome json = test::run_program(folder.path(), options + " --r 3 --json");
  EXPECT_EQ(json.exit_code, 0) << json.err;
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["parameters"]["R"], 3);
  EXPECT_EQ(report["stages"][0]["stage"], "any_bit");
  EXPECT_EQ(report["total"]["gates"], 2);
  EXPECT_EQ(report["total"]["flip_flops"], 1);
  EXPECT_EQ(report["modules"]["cached"], 2);

  for (const char* mistake :
       {" --set table_cache.bytes=65536", " --set mask_test.design=bit-table", " --r 40", " --stages box"}) {
    const test::Outcome refused = test::run_program(folder.path(), options + mistake);
    EXPECT_EQ(refused.exit_code, 2) << mistake;
    EXPECT_NE(refused.err.find("remedy: "), std::string::npos) << mistake << ": " << refused.err;
  }
}

}  // namespace
}  // namespace ctu::area
