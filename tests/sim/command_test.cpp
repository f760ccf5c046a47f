// The program from the outside: a scene becomes a trace, the trace runs with every design, and whatever is wrong with
// the input ends in one message and exit code 2.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;
using nlohmann::json;

/// One small recorded trace for all tests of this program.
long counter(const json& result, const std::string& name) {
  for (const json& entry : result["counters"])
    if (entry["name"] == name) return entry["value"].get<long>();
  ADD_FAILURE() << "no counter " << name;
  return 0;
}

class CommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    const Outcome outcome =
        run_program(folder_->path(),
                    "record 'gen:hair-ball?strands=400&seed=7' -o hair.ctut --size 40x40 --rays diffuse --bounces 2");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static Outcome ctusim(const std::string& arguments) { return run_program(folder_->path(), arguments); }
  static std::filesystem::path file(const std::string& name) { return folder_->path() / name; }
  static json run_json(const std::string& arguments) {
    const Outcome outcome = ctusim("run hair.ctut --json result.json " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json::parse(read_text(file("result.json")));
  }

  /// The message names the place, says a remedy, and the exit code is that of a user's mistake.
  static void expect_refused(const std::string& arguments, const std::string& named) {
    const Outcome outcome = ctusim(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << arguments << "\n" << outcome.err;
  }

  static ScratchFolder* folder_;
};
ScratchFolder* CommandTest::folder_ = nullptr;

TEST_F(CommandTest, every_design_returns_every_ray_with_the_expected_hit) {
  for (const std::string design : {"none", "mask-lut", "projection", "comparators"}) {
    const json result = run_json("--set mask_test.design=" + design);
    EXPECT_EQ(result["wrong_hits"], 0) << design;
    EXPECT_GE(result["rays"].get<int>(), 1600) << design;
    EXPECT_GT(result["cycles"].get<long>(), 0) << design;
  }
}

TEST_F(CommandTest, the_result_file_has_the_keys_that_tools_rely_on) {
  const json result = run_json("");
  for (const char* key : {"rays", "wrong_hits", "cycles", "intersections_per_ray", "cycles_per_ray", "culled_share",
                          "simulated_cycles_per_second", "rays_per_second", "engine", "config_hash", "trace_hash"})
    EXPECT_TRUE(result.contains(key)) << key;
  for (const json& counter : result["counters"]) {
    EXPECT_FALSE(counter["unit"].get<std::string>().empty()) << counter;
    EXPECT_FALSE(counter["description"].get<std::string>().empty()) << counter;
  }
}

TEST_F(CommandTest, every_cycle_of_every_stage_is_accounted_for) {
  const json result = run_json("--set mask_test.design=projection");
  ASSERT_GE(result["stages"].size(), 10u);
  for (const json& stage : result["stages"]) {
    long sum = stage["busy"].get<long>() + stage["idle"].get<long>();
    for (const json& cause : stage["stalled"]) sum += cause["cycles"].get<long>();
    EXPECT_EQ(sum, result["cycles"].get<long>()) << stage["stage"];
  }
}

TEST_F(CommandTest, culling_saves_intersections_and_projection_equals_mask_lut) {
  std::map<std::string, double> work;
  for (const std::string design : {"none", "mask-lut", "projection", "comparators"})
    work[design] = run_json("--set mask_test.design=" + design)["intersections_per_ray"];
  EXPECT_LT(work["mask-lut"], work["none"]);
  EXPECT_EQ(work["mask-lut"], work["projection"]);
  EXPECT_LE(work["comparators"], work["mask-lut"]);
}

TEST_F(CommandTest, modes_and_sources_end_on_the_same_cycle_with_the_same_events) {
  const json batch = run_json("--mode batch --source replay");
  for (const std::string other : {"--mode cycle", "--mode pins", "--mode plain", "--mode batch --source exec"}) {
    const json result = run_json(other);
    EXPECT_EQ(result["cycles"], batch["cycles"]) << other;
    EXPECT_EQ(result["event_log_hash"], batch["event_log_hash"]) << other;
  }
}

TEST_F(CommandTest, the_reference_engine_counts_what_the_unit_counts) {
  const json timed = run_json("");
  const json untimed = run_json("--engine reference");
  EXPECT_EQ(untimed["engine"], "reference");
  EXPECT_EQ(untimed["wrong_hits"], 0);
  EXPECT_EQ(untimed["intersections_per_ray"], timed["intersections_per_ray"]);
  EXPECT_EQ(untimed["culled_share"], timed["culled_share"]);
}

TEST_F(CommandTest, a_shown_configuration_reads_back_as_itself) {
  const Outcome shown = ctusim("config show --set unit.contexts=8 --set mask_test.design=comparators");
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  write_text(file("shown.toml"), shown.out);
  EXPECT_EQ(run_json("-c shown.toml")["config_hash"],
            run_json("--set unit.contexts=8 --set mask_test.design=comparators")["config_hash"]);
}

TEST_F(CommandTest, compare_prints_a_line_for_each_design) {
  const Outcome outcome = ctusim("compare hair.ctut");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* design : {"none", "mask-lut", "projection", "comparators"})
    EXPECT_NE(outcome.out.find(design), std::string::npos) << design;
}

TEST_F(CommandTest, a_heat_map_is_a_png) {
  const Outcome outcome = ctusim("heatmap 'gen:hair-ball?strands=200' -o map.png --size 32x32");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_text(file("map.png")).substr(1, 3), "PNG");
}

TEST_F(CommandTest, a_waveform_covers_its_window) {
  const Outcome outcome = ctusim("run hair.ctut --waves w.vcd --window 100:200");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string vcd = read_text(file("w.vcd"));
  EXPECT_NE(vcd.find("$enddefinitions"), std::string::npos);
  EXPECT_NE(vcd.find("#100"), std::string::npos);
}

TEST_F(CommandTest, a_trace_says_how_it_was_made_and_shows_its_rays) {
  const Outcome info = ctusim("trace info hair.ctut");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("gen:hair-ball"), std::string::npos);
  const Outcome head = ctusim("trace head hair.ctut --rays 2");
  EXPECT_EQ(head.exit_code, 0) << head.err;
  EXPECT_NE(head.out.find("ray 1 closest-hit"), std::string::npos);
  EXPECT_EQ(head.out.find("ray 2 "), std::string::npos);
}

TEST_F(CommandTest, a_culling_survey_loses_no_hit) {
  const Outcome outcome = ctusim("culling 'gen:hair-ball?strands=200' --rays all --size 24x24");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* kind : {"primary", "diffuse", "shadow", "ao", "random"})
    EXPECT_NE(outcome.out.find(kind), std::string::npos) << kind;
}

TEST_F(CommandTest, a_transformed_scene_keeps_its_answers_in_text_markdown_and_json) {
  const std::string command = "metamorph 'gen:tetra?depth=2' --size 8x8 --designs comparators --checks powers,edges";
  const Outcome text = ctusim(command + " --json changed.json");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("x 2^-40"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("4 closed parts of 16 triangles"), std::string::npos) << text.out;
  const json result = json::parse(read_text(folder_->path() / "changed.json"));
  const json& scene = result["scenes"].at(0);
  EXPECT_TRUE(scene["passed"]);
  EXPECT_EQ(scene["transformations"].size(), 5u);
  EXPECT_TRUE(scene["transformations"][1]["same_bits"]);
  EXPECT_EQ(scene["edges"]["leaks"], 0);
  const Outcome markdown = ctusim(command + " --markdown");
  EXPECT_NE(markdown.out.find("x 2^-40; x 2^-1; x 2^7; x 2^40"), std::string::npos) << markdown.out;
}

TEST_F(CommandTest, a_slice_runs_as_a_trace_of_its_own) {
  ASSERT_EQ(ctusim("trace slice hair.ctut -o part.ctut --first 100 --rays 50").exit_code, 0);
  const Outcome outcome = ctusim("run part.ctut --json part.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json::parse(read_text(file("part.json")))["rays"], 50);
}

TEST_F(CommandTest, a_trace_of_compressed_masks_says_so_and_loses_no_hit) {
  const std::string recorded = "record 'gen:hair-ball?strands=200&seed=7' -o packed.ctut --size 32x32 --compress 64";
  ASSERT_EQ(ctusim(recorded + " --selection top-summed").exit_code, 0);
  const Outcome info = ctusim("trace info packed.ctut");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("indices of 6 bits into a compression LUT of 64 entries (64 asked for, top-summed)"),
            std::string::npos)
      << info.out;
  EXPECT_NE(info.out.find("nodes of 116 bytes"), std::string::npos) << info.out;
  const Outcome run = ctusim("run packed.ctut --engine reference --set mask_test.design=bit-table --json packed.json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(read_text(file("packed.json")))["wrong_hits"], 0);
}

TEST_F(CommandTest, designs_that_read_tables_visit_the_same_over_compressed_masks_on_chip_and_cached) {
  ASSERT_EQ(ctusim("record 'gen:hair-ball?strands=200&seed=7' -o packed.ctut --size 32x32 --compress 64").exit_code, 0);
  std::map<std::string, long> visits;
  for (const std::string design : {"mask-lut", "bit-table", "dedup", "projection"})
    for (const std::string tables : {"", "--set mask_test.rows=folded", "--set table_cache.bytes=4096"}) {
      const Outcome outcome =
          ctusim("run packed.ctut --json packed.json --set mask_test.design=" + design + " " + tables);
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      const json result = json::parse(read_text(file("packed.json")));
      EXPECT_EQ(result["wrong_hits"], 0) << design << tables;
      visits[design + tables] = counter(result, "traversal.node_visits") * 1000000 +
                                counter(result, "traversal.culled") + counter(result, "traversal.uncertain");
      if (design == "bit-table" && tables.empty()) {
        EXPECT_EQ(counter(result, "mask_test.bit_table.rows"), 4096);
        EXPECT_EQ(counter(result, "mask_test.bit_table.row_bits"), 64);
        EXPECT_EQ(counter(result, "mask_test.table_bits"), 4096 * 64);
        EXPECT_GT(counter(result, "mask_test.bit_table.rows_used"), 0);
      }
    }
  for (const auto& [run, visited] : visits) EXPECT_EQ(visited, visits.begin()->second) << run;
}

TEST_F(CommandTest, nodes_have_the_bytes_that_masks_and_alignment_ask_for) {
  const std::map<std::string, int> stride_of = {{"", 144},
                                                {"--r 6", 220},
                                                {"--compress 256", 116},
                                                {"--compress 4096", 120},
                                                {"--culling off", 112},
                                                {"--node-align 128", 256},
                                                {"--node-align 128 --compress 16", 128},
                                                {"--node-align 64 --culling off", 128},
                                                {"--box-bits 16", 112},
                                                {"--box-bits 12 --culling off", 68},
                                                {"--box-bits 8 --compress 256", 60}};
  for (const auto& [options, bytes] : stride_of) {
    ASSERT_EQ(ctusim("record 'gen:hair-ball?strands=50' -o stride.ctut --size 8x8 " + options).exit_code, 0) << options;
    const Outcome info = ctusim("trace info stride.ctut");
    EXPECT_NE(info.out.find("nodes of " + std::to_string(bytes) + " bytes"), std::string::npos) << options << info.out;
  }
  ASSERT_EQ(ctusim("record 'gen:hair-ball?strands=50' -o stride.ctut --size 8x8 --triangle-align 64").exit_code, 0);
  EXPECT_NE(ctusim("trace info stride.ctut").out.find("triangles of 64 bytes"), std::string::npos);
}

TEST_F(CommandTest, boxes_of_fewer_bits_give_the_same_hits_with_every_design_and_source) {
  const std::string scene = "record 'gen:hair-ball?strands=100' --size 32x32 -o ";
  ASSERT_EQ(ctusim(scene + "full.ctut").exit_code, 0);
  ASSERT_EQ(ctusim(scene + "few.ctut --box-bits 8").exit_code, 0);
  EXPECT_NE(ctusim("trace info few.ctut").out.find("8 bits for each coordinate"), std::string::npos);
  for (const std::string design : {"none", "projection", "comparators"}) {
    std::map<std::string, json> results;
    for (const std::string trace : {"full", "few"})
      for (const std::string source : {"replay", "exec"}) {
        const Outcome run =
            ctusim("run " + trace + ".ctut --json r.json --source " + source + " --set mask_test.design=" + design);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        results[trace + source] = json::parse(read_text(file("r.json")));
        EXPECT_EQ(results[trace + source]["wrong_hits"], 0);
      }
    EXPECT_EQ(results["fewexec"]["cycles"], results["fewreplay"]["cycles"]) << design;
    EXPECT_EQ(results["fewexec"]["event_log_hash"], results["fewreplay"]["event_log_hash"]) << design;
    if (design == "none") {
      EXPECT_GE(results["fewexec"]["intersections_per_ray"], results["fullexec"]["intersections_per_ray"]);
    }
  }
  const Outcome table = ctusim("precision 'gen:hair-ball?strands=100' --size 16x16 --box-bits 32,8 --designs none");
  EXPECT_EQ(table.exit_code, 0) << table.err;
}

TEST_F(CommandTest, ray_boxes_save_tests_of_triangles_and_spheres_and_change_no_hit) {
  const std::string scene = "record gen:balls --size 24x24 --leaf 15 --triangle-cost 0.05 -o ";
  ASSERT_EQ(ctusim(scene + "plain.ctut").exit_code, 0);
  const Outcome recorded = ctusim(scene + "boxed.ctut --primitive-boxes");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_EQ(recorded.out.find("changed:"), std::string::npos) << recorded.out;
  const std::string info = ctusim("trace info boxed.ctut").out;
  EXPECT_NE(info.find("primitive boxes"), std::string::npos);
  EXPECT_NE(info.find("spheres"), std::string::npos);
  for (const std::string design : {"none", "projection"}) {
    std::map<std::string, json> results;
    for (const std::string run :
         {"plain.ctut", "boxed.ctut", "boxed.ctut --source exec", "boxed.ctut --engine reference"}) {
      const Outcome outcome = ctusim("run " + run + " --json r.json --set mask_test.design=" + design);
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_EQ(outcome.out.find("saved by ray boxes") != std::string::npos, run != "plain.ctut") << run;
      results[run] = json::parse(read_text(file("r.json")));
      EXPECT_EQ(results[run]["wrong_hits"], 0);
    }
    const json& replay = results["boxed.ctut"];
    EXPECT_EQ(replay["event_log_hash"], results["boxed.ctut --source exec"]["event_log_hash"]) << design;
    const auto tests = [](const json& run) { return counter(run, "traversal.triangle_tests"); };
    const long saved = counter(replay, "traversal.boxed_out");
    EXPECT_GT(saved, tests(replay) / 2) << design;
    EXPECT_EQ(tests(results["plain.ctut"]), tests(replay) + saved) << design;
    EXPECT_EQ(counter(replay, "primitive_cull.culled"), saved);
    EXPECT_EQ(counter(results["boxed.ctut --engine reference"], "traversal.boxed_out"), saved);
  }
  expect_refused("run boxed.ctut --set stack.spill_batch=16", "16-byte entries");
  expect_refused("run boxed.ctut --set primitive_cull.units=5", "primitive_cull.units");
}

TEST_F(CommandTest, nodes_whose_masks_are_full_take_no_bytes_for_them_and_change_no_work) {
  const std::string scene = "record 'gen:hair-ball?strands=200&seed=7' --size 32x32 --compress 16 -o ";
  ASSERT_EQ(ctusim(scene + "whole.ctut").exit_code, 0);
  ASSERT_EQ(ctusim(scene + "bare.ctut --strip-full").exit_code, 0);
  EXPECT_NE(ctusim("trace info bare.ctut").out.find("of 112 bytes without masks"), std::string::npos);
  for (const std::string design : {"none", "mask-lut", "bit-table", "comparators"}) {
    std::map<std::string, json> results;
    for (const std::string trace : {"whole", "bare"}) {
      for (const std::string source : {"replay", "exec"}) {
        const Outcome run =
            ctusim("run " + trace + ".ctut --json r.json --source " + source + " --set mask_test.design=" + design);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        results[trace + source] = json::parse(read_text(file("r.json")));
      }
      EXPECT_EQ(results[trace + "exec"]["event_log_hash"], results[trace + "replay"]["event_log_hash"]) << design;
      EXPECT_EQ(results[trace + "exec"]["cycles"], results[trace + "replay"]["cycles"]) << design;
    }
    EXPECT_EQ(results["bareexec"]["intersections_per_ray"], results["wholeexec"]["intersections_per_ray"]) << design;
    EXPECT_EQ(results["bareexec"]["wrong_hits"], 0) << design;
  }
}

TEST_F(CommandTest, a_trace_without_masks_runs_without_culling_only) {
  ASSERT_EQ(ctusim("record 'gen:hair-ball?strands=50' -o bare.ctut --size 8x8 --culling off").exit_code, 0);
  EXPECT_EQ(ctusim("run bare.ctut --set mask_test.design=none").exit_code, 0);
  expect_refused("run bare.ctut --set mask_test.design=projection", "carries no masks");
  expect_refused("run bare.ctut --engine reference --set mask_test.design=comparators", "carries no masks");
}

TEST_F(CommandTest, tables_prints_exact_bits_and_says_what_is_refused) {
  const Outcome small = ctusim("tables --r 4 --entries 256");
  EXPECT_EQ(small.exit_code, 0) << small.err;
  for (const char* text : {"ray masks 4096 x 64", "bit table 4096 x 256", "1048576", "ids 4096 x 11", "280 x 64"})
    EXPECT_NE(small.out.find(text), std::string::npos) << text;
  const Outcome large = ctusim("tables --r 8 --r-ray 24");
  EXPECT_EQ(large.exit_code, 0) << large.err;
  EXPECT_NE(large.out.find("refused: R_ray^6 masks of R = 8"), std::string::npos) << large.out;
  EXPECT_NE(large.out.find("331776 x 64"), std::string::npos) << large.out;
}

TEST_F(CommandTest, a_resolution_whose_table_is_too_large_is_recorded_all_the_same) {
  ASSERT_EQ(ctusim("record 'gen:hair-ball?strands=50' -o fine.ctut --size 8x8 --r 8 --r-ray 24").exit_code, 0);
  EXPECT_EQ(ctusim("run fine.ctut --engine reference --set mask_test.design=projection").exit_code, 0);
  expect_refused("run fine.ctut --engine reference --set mask_test.design=mask-lut", "ray-mask table");
}

TEST_F(CommandTest,
       shadow_rays_find_the_same_in_local_trees_with_every_culling_at_once_and_the_run_says_who_saved_what) {
  const std::string scene = "record 'gen:foliage?twigs=100' --size 200x150 --rays shadow --leaf 8 --triangle-cost 0.3 ";
  ASSERT_EQ(ctusim(scene + "-o one.ctut").exit_code, 0);
  const Outcome recorded =
      ctusim(scene + "-o all.ctut --trees 4 --primitive-boxes --packets 8 --packet-forming origin");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_NE(recorded.out.find("local trees; "), std::string::npos) << recorded.out;
  EXPECT_NE(ctusim("trace info all.ctut").out.find("in the image, "), std::string::npos);
  EXPECT_NE(ctusim("trace head all.ctut --rays 8").out.find("walks tree "), std::string::npos);
  EXPECT_EQ(ctusim("trace areas all.ctut").exit_code, 0);
  std::map<std::string, json> results;
  for (const std::string run : {"one", "all", "all --source exec", "all --engine reference"}) {
    const Outcome outcome = ctusim("run " + run.substr(0, 3) + ".ctut --json r.json" + run.substr(3));
    ASSERT_EQ(outcome.exit_code, 0) << run << outcome.err;
    results[run] = json::parse(read_text(file("r.json")));
    EXPECT_EQ(results[run]["wrong_hits"], 0) << run;
    if (run != "all") continue;
    for (const char* saved : {"culled share", "saved by ray boxes", "saved by packets", "saved by local trees"})
      EXPECT_NE(outcome.out.find(saved), std::string::npos) << saved << outcome.out;
  }
  EXPECT_EQ(results["all"]["event_log_hash"], results["all --source exec"]["event_log_hash"]);
  EXPECT_EQ(results["all"]["rays"], results["one"]["rays"]);
}

TEST_F(CommandTest, rays_in_packets_find_the_same_hits_with_every_engine_and_source_and_say_what_they_saved) {
  const std::string scene = "record 'gen:tilted-quads?quads=300' --size 40x40 --rays primary -o ";
  ASSERT_EQ(ctusim(scene + "alone.ctut").exit_code, 0);
  const Outcome recorded =
      ctusim(scene + "together.ctut --packets 8 --packet-entries 2 --packet-forming direction --packet-window 64");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_NE(recorded.out.find("200 packets"), std::string::npos) << recorded.out;
  const Outcome info = ctusim("trace info together.ctut");
  EXPECT_NE(info.out.find("of 8 rays, up to 2 entries; rays of a window of 64 by direction"), std::string::npos)
      << info.out;
  EXPECT_NE(ctusim("trace head together.ctut --rays 8").out.find("packet of 8 rays"), std::string::npos);
  for (const std::string design : {"none", "projection", "comparators"}) {
    std::map<std::string, json> results;
    for (const std::string run : {"alone", "together", "together --source exec", "together --engine reference",
                                  "together --mode pins", "together --first 5 --rays 1001"}) {
      const std::string trace = run.substr(0, run.find(' ')), rest = run.substr(trace.size());
      const Outcome outcome =
          ctusim("run " + trace + ".ctut --json r.json" + rest + " --set mask_test.design=" + design);
      ASSERT_EQ(outcome.exit_code, 0) << run << outcome.err;
      results[run] = json::parse(read_text(file("r.json")));
      EXPECT_EQ(results[run]["wrong_hits"], 0) << run;
    }
    EXPECT_EQ(results["together"]["event_log_hash"], results["together --source exec"]["event_log_hash"]) << design;
    EXPECT_EQ(results["together"]["event_log_hash"], results["together --mode pins"]["event_log_hash"]) << design;
    EXPECT_EQ(results["together"]["intersections_per_ray"],
              results["together --engine reference"]["intersections_per_ray"]);
    EXPECT_LT(results["together"]["intersections_per_ray"], results["alone"]["intersections_per_ray"]);
    std::map<std::string, long> counters;
    for (const json& counter : results["together"]["counters"]) counters[counter["name"]] = counter["value"];
    EXPECT_EQ(counters["packets.packets"], 200);
    EXPECT_GT(counters["packets.node_tests_saved"], counters["packets.node_visits"]);
    for (const json& counter : results["alone"]["counters"])
      EXPECT_FALSE(counter["name"].get<std::string>().starts_with("packets."));
  }
  expect_refused("run together.ctut --set unit.contexts=7", "unit.contexts");
  expect_refused("run together.ctut --set packet_cull.packets=0", "packet_cull.packets");
  expect_refused("run together.ctut --engine estimate", "packets");
  expect_refused("trace slice together.ctut -o x.ctut --first 5 --rays 16", "cut a packet in two");
  EXPECT_EQ(ctusim("trace slice together.ctut -o part.ctut --first 8 --rays 16").exit_code, 0);
  EXPECT_EQ(ctusim("run part.ctut").exit_code, 0);
}

TEST_F(CommandTest, a_survey_of_packets_has_a_row_for_the_rays_alone_and_one_for_each_size_and_number_of_entries) {
  const Outcome table = ctusim(
      "packets 'gen:tilted-quads?quads=200' --size 24x24 --rays primary --packets 4,16 --packet-entries 1,3 "
      "--markdown");
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_NE(table.out.find("128 contexts, 8 packets under way, mask test projection; packets by order"),
            std::string::npos)
      << table.out;
  std::size_t rows = 0;
  for (std::size_t at = table.out.find("| primary |"); at != std::string::npos;
       at = table.out.find("| primary |", at + 1))
    ++rows;
  EXPECT_EQ(rows, 5u) << table.out;
  for (const char* cells : {"| primary | - | - |", "| primary | 4 | 1 |", "| primary | 16 | 3 |"})
    EXPECT_NE(table.out.find(cells), std::string::npos) << cells << table.out;
  const Outcome few = ctusim("packets gen:tetra --size 8x8 --rays all --packets 8 --packet-entries 2 --sample 200");
  EXPECT_EQ(few.exit_code, 0) << few.err;
}

TEST_F(CommandTest, mistakes_of_the_user_end_in_one_message_and_exit_code_2) {
  expect_refused("run missing.ctut", "missing.ctut");
  expect_refused("run hair.ctut --set mask_test.desing=none", "mask_test.design");
  expect_refused("run hair.ctut --set mask_test.design=projektion", "projection");
  expect_refused("run hair.ctut --set unit.contexts=0", "unit.contexts");
  expect_refused("run hair.ctut --set unit.contexts=many", "unit.contexts");
  expect_refused("run hair.ctut --set unit.contexts", "--set unit.contexts");
  expect_refused("run hair.ctut --set mask_test.design=bit-table", "--compress");
  expect_refused("run hair.ctut --set mask_test.rows=few", "reachable");
  expect_refused("run hair.ctut --set table_cache.bytes=1000", "table_cache.bytes");
  expect_refused("run hair.ctut --window 5", "--window");
  expect_refused("run hair.ctut --engine hardware", "--engine");
  expect_refused("run hair.ctut --mode turbo", "--mode");
  for (const std::string engine : {"reference", "rtl", "both", "estimate"}) {
    expect_refused("run hair.ctut --mode plain --engine " + engine, "--mode: engine " + engine);
    expect_refused("run hair.ctut --source exec --engine " + engine, "--source: engine " + engine);
  }
  for (const std::string engine : {"reference", "rtl", "estimate"})
    expect_refused("run hair.ctut --waves w.vcd --window 0:9 --engine " + engine, "--waves: engine " + engine);
  expect_refused("record nowhere.obj -o x.ctut", "nowhere.obj");
  expect_refused("paper all --quick --page nowhere.md", "nowhere.md");
  expect_refused("record gen:hair-bal -o x.ctut", "hair-ball");
  expect_refused("record gen:hair-ball -o x.ctut --size big", "--size");
  expect_refused("record gen:hair-ball -o x.ctut --r 9", "--r");
  expect_refused("record gen:hair-ball -o x.ctut --r 6 --r-ray 5", "--r-ray");
  expect_refused("record gen:hair-ball -o x.ctut --r-ray 25", "--r-ray");
  expect_refused("tables --r 6 --r-ray 5", "R_ray");
  expect_refused("tables --entries 8", "entries");
  expect_refused("tables --projection-tables 2", "--projection-tables");
  expect_refused("record gen:hair-ball -o x.ctut --l 7", "--l");
  for (const std::string command :
       {"record gen:hair-ball -o x.ctut", "culling gen:hair-ball", "heatmap gen:hair-ball -o x.png"}) {
    expect_refused(command + " --compress 0", "--compress");
    expect_refused(command + " --compress 15", "--compress");
    expect_refused(command + " --compress 4097", "--compress");
    expect_refused(command + " --compress 64 --selection best", "--selection");
    expect_refused(command + " --selection refined", "--compress 256");
    expect_refused(command + " --r 4 --r-ray 3", "--r-ray");
    expect_refused(command + " --r 4 --r-ray 25", "--r-ray");
  }
  for (const std::string command : {"culling nowhere.obj --designs ", "heatmap nowhere.obj -o x.png --design "}) {
    expect_refused(command + "mask-lut --r 8 --r-ray 24", "ray-mask table");  // before the scene is looked for
    expect_refused(command + "dedup --r 8 --r-ray 24", "deduplicated ray masks");
    expect_refused(command + "bit-table --r-ray 24 --compress 4096", "bit table");
    expect_refused(command + "bit-table", "not compressed");
  }
  expect_refused("record gen:hair-ball -o x.ctut --node-align 24", "--node-align");
  expect_refused("record gen:hair-ball -o x.ctut --box-bits 10", "--box-bits");
  expect_refused("precision gen:hair-ball --box-bits 32,", "--box-bits");
  expect_refused("record gen:hair-ball -o x.ctut --triangle-align 0", "--triangle-align");
  expect_refused("record gen:hair-ball -o x.ctut --trees 256", "local trees");
  expect_refused("record gen:hair-ball -o x.ctut --trees -1", "local trees");
  expect_refused("record gen:hair-ball -o x.ctut --trees 2 --culling auto", "--trees");
  expect_refused("record gen:hair-ball -o x.ctut --packets 3", "packets");
  expect_refused("record gen:hair-ball -o x.ctut --packets 65", "packets");
  expect_refused("record gen:hair-ball -o x.ctut --packets -8", "packets");
  expect_refused("record gen:hair-ball -o x.ctut --packets 8 --packet-entries 0", "packet entries");
  expect_refused("record gen:hair-ball -o x.ctut --packets 8 --packet-entries 17", "packet entries");
  expect_refused("record gen:hair-ball -o x.ctut --packets 8 --packet-forming size", "--packet-forming");
  expect_refused("record gen:hair-ball -o x.ctut --packets 8 --packet-window 7", "packet window");
  expect_refused("record gen:hair-ball -o x.ctut --packets 8 --culling auto", "--packets");
  expect_refused("record gen:hair-ball -o x.ctut --packet-entries 2", "--packets");
  expect_refused("packets gen:hair-ball --packets 8,", "--packets");
  expect_refused("packets gen:hair-ball --packets 2", "packet size");
  expect_refused("packets gen:hair-ball --packet-entries 17", "packet entries");
  expect_refused("packets gen:hair-ball --packet-forming size", "--packet-forming");
  expect_refused("packets gen:hair-ball --packets 64 --set unit.contexts=63", "more than the unit's 63 contexts");
  expect_refused("record gen:hair-ball -o x.ctut --culling off --strip-full", "--strip-full");
  expect_refused("record gen:hair-ball -o x.ctut --culling maybe", "--culling");
  expect_refused("record gen:hair-ball -o x.ctut --culling off --designs none,mask-lut", "--designs");
  expect_refused("record gen:hair-ball -o x.ctut --culling off --compress 64", "--compress");
  expect_refused("record gen:hair-ball -o no/such/folder/x.ctut", "no/such/folder");
  expect_refused("record gen:hair-ball", "--output");
  expect_refused("record gen:hair-ball -o x.ctut --eye nan,0,0", "--eye");
  expect_refused("record gen:hair-ball -o x.ctut --eye 1,2", "--eye");
  expect_refused("record gen:hair-ball -o x.ctut --eye 1,2,3 --target 1,2,3", "--eye");
  expect_refused("record gen:hair-ball -o x.ctut --thickness -1", "--thickness");
  expect_refused("record gen:hair-ball -o x.ctut --sides 1", "--sides");
  expect_refused("record gen:hair-ball -o x.ctut --sides 17", "--sides");
  expect_refused("record gen:hair-ball -o x.ctut --without leaf.ply", "leaf.ply");
  expect_refused("record gen:hair-ball -o x.ctut --threads -1", "--threads");
  expect_refused("record gen:hair-ball -o x.ctut --fov 500", "field of view");
  expect_refused("run hair.ctut --json no/such/folder/r.json", "no/such/folder");
  expect_refused("metamorph gen:tetra --checks mirors", "mirrors");
  expect_refused("metamorph gen:tetra --designs projektion", "projection");
  expect_refused("metamorph gen:tetra --json no/such/folder/m.json", "no/such/folder");
  expect_refused("metamorph", "SCENE");
  expect_refused("", "subcommand");
}

TEST_F(CommandTest, a_broken_configuration_is_refused_with_file_and_line) {
  write_text(file("bad.toml"), "[unit]\ncontexts = 16\n[mask_test]\ndesing = \"none\"\n");
  expect_refused("run hair.ctut -c bad.toml", "bad.toml:4");
  write_text(file("broken.toml"), "contexts = \n");
  expect_refused("run hair.ctut -c broken.toml", "broken.toml:1");
  expect_refused("run hair.ctut -c absent.toml", "absent.toml");
}

TEST_F(CommandTest, a_truncated_or_foreign_trace_is_refused) {
  const std::string bytes = read_text(file("hair.ctut"));
  for (const std::size_t keep : {std::size_t{0}, std::size_t{3}, bytes.size() / 2, bytes.size() - 1}) {
    write_text(file("cut.ctut"), bytes.substr(0, keep));
    expect_refused("run cut.ctut", "cut.ctut");
  }
  write_text(file("foreign.ctut"),
             "this is not a trace, but it is long enough to look like one" + std::string(4096, ' '));
  expect_refused("run foreign.ctut", "foreign.ctut");
}

}  // namespace
