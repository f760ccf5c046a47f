#include "sim/cli.h"

#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "model/base/version.h"
#include "sim/commands.h"
#include "sim/ladder/ladder_command.h"
#include "sim/report/report_command.h"
#include "sim/sweep/sweep_command.h"
#include "sim/tailor/tailor_command.h"

namespace ctu::sim {
namespace {

/// A number that is not less than `least`, refused in words: CLI11's own validators print the largest double.
CLI::Validator at_least(int least) {
  const auto check = [least](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && value >= least ? std::string()
                                                 : fmt::format("{}: give a number from {} on", text, least);
  };
  return CLI::Validator(check, "");
}

void add_index_option(CLI::App& app, SceneArgs& args) {
  app.add_option("--index", args.index,
                 "file with a line NAME PATH for each scene; SCENE may be such a NAME, no SCENE means all");
}

void add_model_options(CLI::App& app, SceneArgs& args) {
  app.add_option("--thickness", args.strand_thickness,
                 "width of strands, ribbons or tubes, in scene units; 0: from the file");
  app.add_option("--sides", args.strand_sides, "sides of a strand: 2 for a ribbon, 3 to 16 for a tube")
      ->capture_default_str();
  app.add_option("--without", args.without,
                 "leave out the files of these names that the scene names, without folders, * for any letters: "
                 "--without 'leaf_*,stem.ply'")
      ->delimiter(',')
      ->expected(1)
      ->take_all();
}

void add_scene_options(CLI::App& app, SceneArgs& args, bool several) {
  auto* scene = app.add_option("scene", args.scenes,
                               "scene file (.obj .ply .gltf .glb .pbrt .scn .hair .tfx .nff .list, each also .zst) or "
                               "a generated one: gen:hair-ball?strands=2000&seed=1");
  scene->expected(several ? 0 : 1, several ? -1 : 1);
  if (several)
    add_index_option(app, args);
  else
    scene->required();
  add_model_options(app, args);
  app.add_option("--eye", args.eye, "camera position x,y,z; otherwise the scene's own, or one that sees all of it");
  app.add_option("--target", args.target, "what the camera looks at, x,y,z");
  app.add_option("--up", args.up, "direction that is up in the picture, x,y,z");
  app.add_option("--fov", args.vertical_fov, "vertical field of view in degrees");
  app.add_option("--turn", args.turn, "degrees X,Y,Z by which scene and camera are turned about the axes");
  app.add_option("--rays", args.rays, "primary, diffuse, shadow, ao or random")->capture_default_str();
  app.add_option("--size", args.size, "picture size in pixels, WxH")->capture_default_str();
  app.add_option("--spp", args.spp, "samples per pixel")->capture_default_str();
  app.add_option("--bounces", args.bounces, "diffuse: bounces after the primary ray, at most")->capture_default_str();
  app.add_option("--seed", args.seed, "seed of every random number")->capture_default_str();
  app.add_option("--count", args.count, "random: number of rays; 0: pixels times samples")->capture_default_str();
  app.add_flag("--skip-primary", args.skip_primary, "diffuse: leave the primary rays out");
  app.add_option("--r", args.resolution, "R: cells per axis of an object mask, 2..8")->capture_default_str();
  app.add_option("--r-ray", args.ray_resolution, "R_ray: cells per axis of the ray's key; 0: as --r")
      ->capture_default_str();
  app.add_option("--l", args.levels, "L: levels below from which masks are made, 1..5 or inf")->capture_default_str();
  app.add_option("--compress", args.compress,
                 "entries of a compression LUT that replaces object masks by indices, 16..4096; without it they are "
                 "stored as they are");
  app.add_option("--selection", args.selection,
                 "how its entries are chosen: top-per-node and top-summed (the paper's), refined (the default)");
  app.add_option("--leaf", args.leaf_triangles, "triangles in a leaf, at most")->capture_default_str();
  app.add_option("--triangle-cost", args.triangle_cost,
                 "cost of a triangle test in the builder, relative to a test of 4 boxes")
      ->capture_default_str();
  app.add_option("--threads", args.threads, "0: one for each core; results do not depend on it")->capture_default_str();
}

void add_config_options(CLI::App& app, UnitArgs& args) {
  app.add_option("-c,--config", args.config_path, "TOML file with the unit's parameters");
  app.add_option("--set", args.sets, "KEY=VALUE over the file; may be repeated")->expected(1)->take_all();
}

void add_unit_options(CLI::App& app, UnitArgs& args) {
  add_config_options(app, args);
  app.add_option("--mode", args.mode, "plain, batch, cycle or pins: the same cycles at different speeds")
      ->capture_default_str();
  app.add_option("--source", args.source, "replay recorded outcomes, or exec: compute them")->capture_default_str();
}

/// Commands share one place for their arguments, filled while the command line is parsed.
struct Parsed {
  RecordArgs record;
  RunArgs run;
  CompareArgs compare;
  CullingArgs culling;
  MetamorphArgs metamorph;
  DecideArgs decide;
  PrecisionArgs precision;
  PacketsArgs packets;
  CompressionArgs compression;
  HeatmapArgs heatmap;
  TablesArgs tables;
  AreaArgs area;
  PaperArgs paper, paper_raydist, paper_raybox;
  PaperPacketsArgs paper_packets;
  PaperAllArgs paper_all;
  TraceArgs trace;
  UnitArgs config;
  bool config_plain = false;
  BenchArgs bench;
  CheckArgs check;
  sweep::SweepArgs sweep;
  report::ReportArgs report;
  tailor::TailorArgs tailor;
  ladder::LadderArgs ladder;
  int exit_code = 0;
};

void add_record(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("record", "build the tree and its masks, record the rays of a scene");
  add_scene_options(*command, parsed.record.scene, false);
  command->add_option("-o,--output", parsed.record.output, "trace file to write (.ctut)")->required();
  command->add_option("--designs", parsed.record.designs,
                      "whose event sequences to store, others are derived at a run; without it "
                      "none,mask-lut,comparators, or none when culling is off");
  command
      ->add_option(
          "--culling", parsed.record.culling,
          "on; off: nodes carry no masks, only design none is recorded; auto: as a simulated sample of the rays "
          "says that it pays on the unit of -c and --set")
      ->capture_default_str();
  add_config_options(*command, parsed.record.unit);
  command->add_flag("--strip-full", parsed.record.strip_full, "nodes whose masks are all full carry none");
  command->add_option("--node-align", parsed.record.node_alignment_bytes, "bytes that a node starts at a multiple of")
      ->capture_default_str();
  command
      ->add_option("--box-bits", parsed.record.box_bits,
                   "of each coordinate of a node's boxes: 32, or 16, 12 or 8 of boxes rounded outward")
      ->capture_default_str();
  command->add_flag("--primitive-boxes", parsed.record.primitive_boxes,
                    "a box beside every primitive, with which the unit culls primitives of a leaf before testing them");
  command
      ->add_option("--triangle-align", parsed.record.triangle_alignment_bytes,
                   "bytes that a triangle starts at a multiple of")
      ->capture_default_str();
  command
      ->add_option("--trees", parsed.record.trees,
                   "lights that shadow rays get a tree of their own for, at most, 1 to 255; 0: one tree for all rays")
      ->capture_default_str();
  command
      ->add_option("--packets", parsed.record.packets, "rays that enter the tree together, 4 to 64; 0: every ray alone")
      ->capture_default_str();
  command->add_option("--packet-entries", parsed.record.packet_entries,
                      "places where a packet's rays go on alone, at most; 1 to 16 [8]");
  command->add_option(
      "--packet-forming", parsed.record.packet_forming,
      "which rays travel together: in the order in which they come, or those of a window by direction or "
      "origin [order]");
  command->add_option("--packet-window", parsed.record.packet_window,
                      "consecutive rays that packets are formed from [1024]");
  command->callback([&] { parsed.exit_code = record_command(parsed.record); });
}

void add_run(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("run", "replay a trace through the unit and check every ray");
  command->add_option("trace", parsed.run.trace, "trace file")->required();
  add_unit_options(*command, parsed.run.unit);
  command
      ->add_option(
          "--engine", parsed.run.engine,
          "cycle: the timed unit; reference: untimed; rtl: the unit in gates; both: in lock step; estimate: in "
          "closed form; sampled: the timed unit on chunks of the rays")
      ->capture_default_str();
  command->add_option("--json", parsed.run.json_path, "write the result here");
  command->add_option("--waves", parsed.run.waves_path, "write a waveform (VCD) of --window here");
  command->add_option("--timeline", parsed.run.timeline_path,
                      "write each ray's way through the stages in --window here: .kanata or .kanata.zst for Konata, "
                      ".pftrace for Perfetto");
  command->add_option("--window", parsed.run.window, "cycles A:B of the waveform, or of the timeline [0:4999]");
  command->add_option("--energy", parsed.run.energy_path,
                      "table of energies and areas (TOML) instead of the 45 nm one");
  command
      ->add_option("--error", parsed.run.error, "sampled: half of the interval, relative; more is simulated until then")
      ->capture_default_str();
  command->add_option("--confidence", parsed.run.confidence, "sampled: with which the interval holds the cycles")
      ->capture_default_str();
  command->add_option("--seed", parsed.run.seed, "sampled: of the chunks' places")->capture_default_str();
  command->add_option("--first", parsed.run.first_ray, "first ray")->capture_default_str();
  command->add_option("--rays", parsed.run.rays, "number of rays; 0: to the end")->capture_default_str();
  command->callback([&parsed, command] {
    parsed.run.gives_mode = command->count("--mode") != 0;
    parsed.run.gives_source = command->count("--source") != 0;
    parsed.run.gives_sampling =
        command->count("--error") + command->count("--confidence") + command->count("--seed") != 0;
    parsed.exit_code = run_command(parsed.run);
  });
}

void add_compare(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("compare", "run traces with several mask-test designs, a line each");
  command->add_option("traces", parsed.compare.traces, "trace files")->required();
  add_unit_options(*command, parsed.compare.unit);
  command->add_option("--designs", parsed.compare.designs, "list of designs")->capture_default_str();
  command->add_flag("--markdown", parsed.compare.markdown, "print a Markdown table, without speeds");
  command->callback([&] { parsed.exit_code = compare_command(parsed.compare); });
}

void add_culling(CLI::App& app, Parsed& parsed) {
  auto* command =
      app.add_subcommand("culling", "intersections with each design relative to none, untimed, no trace kept");
  add_scene_options(*command, parsed.culling.scene, true);
  command->add_option("--designs", parsed.culling.designs, "list of designs")->capture_default_str();
  command->add_flag("--markdown", parsed.culling.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = culling_command(parsed.culling); });
}

void add_metamorph(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand(
      "metamorph",
      "whole scenes scaled, moved, permuted and mirrored, rays reversed and aimed at the edges of what is closed: "
      "answers that must be the same are compared, others judged by exact arithmetic");
  MetamorphArgs& args = parsed.metamorph;
  args.scene.rays = "all";
  args.scene.size = "48x27";
  add_scene_options(*command, args.scene, true);
  command->add_option("--designs", args.designs, "list of designs")->capture_default_str();
  command
      ->add_option("--checks", args.checks,
                   "list of powers, factors, moves, axes, mirrors, reversed, edges; the scene as it is always comes "
                   "first")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--aimed", args.aimed, "rays at edges and vertices of a scene, at most; 0: at all of them")
      ->capture_default_str();
  command->add_option("--json", args.json_path, "write the result here");
  command->add_flag("--markdown", args.markdown, "print Markdown tables, a row for each kind of transformation");
  command->callback([&] { parsed.exit_code = metamorph_command(parsed.metamorph); });
}

void add_decide(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand(
      "decide", "whether culling pays, in which nodes, as a sample of the rays says, and whether all rays agree");
  add_scene_options(*command, parsed.decide.scene, true);
  add_config_options(*command, parsed.decide.unit);
  command->add_option("--pilot", parsed.decide.pilot_rays, "rays that are simulated for each forecast, about")
      ->capture_default_str();
  command->add_flag("--markdown", parsed.decide.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = decide_command(parsed.decide); });
}

void add_precision(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand(
      "precision", "what boxes of fewer bits cost in intersections and save in bytes and cycles, the same rays in all");
  PrecisionArgs& args = parsed.precision;
  add_scene_options(*command, args.scene, true);
  add_config_options(*command, args.unit);
  command->add_option("--designs", args.designs, "list of designs")->capture_default_str();
  command->add_option("--box-bits", args.box_bits, "list of bits of a coordinate; the first is what others are against")
      ->capture_default_str();
  command->add_option("--sample", args.rays, "rays that are simulated for each scene, about; 0: all")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--out", args.output, "folder for the plot and its data");
  command->add_flag("--markdown", args.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = precision_command(parsed.precision); });
}

void add_packets(CLI::App& app, Parsed& parsed) {
  auto* command =
      app.add_subcommand("packets", "what rays in packets save or cost in the unit, beside the same rays alone");
  PacketsArgs& args = parsed.packets;
  add_scene_options(*command, args.scene, true);
  add_config_options(*command, args.unit);
  command->add_option("--packets", args.sizes, "list of rays of a packet, 4 to 64")->capture_default_str();
  command->add_option("--packet-entries", args.entries, "list of places where a packet's rays go on alone, at most")
      ->capture_default_str();
  command->add_option("--packet-forming", args.forming, "order, direction or origin: how the window is sorted")
      ->capture_default_str();
  command->add_option("--packet-window", args.window, "consecutive rays that packets are formed from")
      ->capture_default_str();
  command->add_option("--sample", args.rays, "rays that are simulated of each kind, about; 0: all")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_flag("--markdown", args.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = packets_command(parsed.packets); });
}

void add_compression(CLI::App& app, Parsed& parsed) {
  auto* command =
      app.add_subcommand("compression", "what compressed masks cost with each selection of entries, untimed");
  add_scene_options(*command, parsed.compression.scene, true);
  command->add_flag("--ideas", parsed.compression.ideas, "also ideas that did not become a selection");
  command->add_flag("--markdown", parsed.compression.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = compression_command(parsed.compression); });
}

void add_heatmap(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("heatmap", "picture of intersections per pixel without and with culling");
  add_scene_options(*command, parsed.heatmap.scene, false);
  command->add_option("-o,--output", parsed.heatmap.output, "PNG file to write")->required();
  command->add_option("--design", parsed.heatmap.design, "mask-test design of the right half")->capture_default_str();
  command->add_option("--range", parsed.heatmap.range, "intersections at the bright end; 0: chosen from the scene")
      ->capture_default_str();
  command->callback([&] { parsed.exit_code = heatmap_command(parsed.heatmap); });
}

void add_tables(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("tables", "bits on chip of each mask-test design, by the rows that are there");
  TablesArgs& args = parsed.tables;
  command->add_option("--r", args.resolution, "R: cells per axis of an object mask, 2..8")->capture_default_str();
  command->add_option("--r-ray", args.ray_resolution, "R_ray: cells per axis of the ray's key; 0: as --r")
      ->capture_default_str();
  command->add_option("--entries", args.entries, "of the compression LUT; 0: object masks are not compressed")
      ->capture_default_str();
  command->add_option("--projection-tables", args.projection_tables, "3, or 1 that is read three times a lane")
      ->capture_default_str();
  command->add_flag("--markdown", args.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = tables_command(parsed.tables); });
}

void add_area(CLI::App& app, Parsed& parsed) {
  auto* command =
      app.add_subcommand("area", "gates, flip-flops, memory bits and logic depth of the unit's RTL, by stage");
  AreaArgs& args = parsed.area;
  add_config_options(*command, args.unit);
  command->add_option("--r", args.resolution, "R: cells per axis of an object mask, 2..8")->capture_default_str();
  command->add_option("--r-ray", args.ray_resolution, "R_ray: cells per axis of the ray's key; 0: as --r")
      ->capture_default_str();
  command->add_option("--entries", args.entries, "of the compression LUT; 0: object masks are not compressed")
      ->capture_default_str();
  command->add_option("--box-bits", args.box_bits, "of each coordinate of the image's boxes: 32, 16, 12 or 8")
      ->capture_default_str();
  command->add_flag("--primitive-boxes", args.primitive_boxes, "of an image with a box beside every primitive");
  command->add_flag("--spheres", args.spheres, "of an image with spheres");
  command
      ->add_option("--packet-entries", args.packet_entries,
                   "of rays in packets, each with so many entries at most; 0: rays travel alone")
      ->capture_default_str();
  command->add_option("--trees", args.trees, "of an image with so many trees, 1..256")->capture_default_str();
  command->add_option("--stages", args.stages, "only these, by name: cell_locate,mask_test; none: all");
  command->add_flag("--fpga", args.fpga, "also LUT4, DSP and block RAM of the Lattice ECP5 family");
  command->add_option("--rtl", args.rtl, "folder of the RTL's sources; without it that of the source tree");
  command->add_option(
      "--cache", args.cache,
      "folder for modules that were synthesised; without it ctusim/area in $XDG_CACHE_HOME or ~/.cache");
  command->add_option("--yosys", args.yosys, "the program")->capture_default_str();
  command->add_option("--threads", args.threads, "runs of yosys at a time; 0: one for each core")
      ->capture_default_str();
  command->add_flag("--json", args.json, "print JSON");
  command->add_flag("--markdown", args.markdown, "print the rows of a Markdown table");
  command->callback([&] { parsed.exit_code = area_command(parsed.area); });
}

void add_paper_raydist(CLI::App& paper, Parsed& parsed) {
  auto* command = paper.add_subcommand(
      "raydist", "ray-distribution-aware trees: predicted and measured costs, build times, areas found from the rays");
  PaperArgs& args = parsed.paper_raydist;
  SceneArgs& scene = args.scene;
  scene.size.clear();
  scene.spp = 0;
  scene.leaf_triangles = 2;
  command->add_option("scene", scene.scenes,
                      "scenes: names of the index, files or generated ones; none: one of each kind");
  add_index_option(*command, scene);
  command->add_flag("--quick", args.quick, "96x54 pixels instead of 240x135, fewer affine rays");
  command->add_option("--size", scene.size, "picture size in pixels, WxH");
  command->add_option("--seed", scene.seed, "seed of every random number")->capture_default_str();
  add_model_options(*command, scene);
  command->add_option("--leaf", scene.leaf_triangles, "triangles in a leaf, at most")->capture_default_str();
  command->add_option("--threads", scene.threads, "0: one for each core")->capture_default_str();
  command->callback([&] { parsed.exit_code = paper_raydist_command(args); });
}

void add_paper_packets(CLI::App& paper, Parsed& parsed) {
  auto* command = paper.add_subcommand(
      "packets", "packet culling: what each method finds of what all rays of a packet miss, as Markdown tables");
  PaperPacketsArgs& args = parsed.paper_packets;
  SceneArgs& scene = args.scene;
  scene.rays = "all";
  scene.size = "1920x1080";
  command->add_option("scene", scene.scenes,
                      "scenes: names of the index, files or generated ones; none: one of each kind");
  add_index_option(*command, scene);
  command->add_option("--rays", scene.rays, "all, or one of primary, diffuse, shadow, ao and random")
      ->capture_default_str();
  command->add_option("--size", scene.size, "picture size in pixels, WxH")->capture_default_str();
  command->add_option("--sample", args.sample, "rays of each kind, about so many of the picture's; 0: all")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--packet", args.size, "rays of a packet, 4 to 64")->capture_default_str();
  command->add_option("--window", args.window, "consecutive rays that packets are formed from")->capture_default_str();
  command->add_option("--forming", args.forming, "order, direction or origin: how the window is sorted")
      ->capture_default_str();
  command->add_option("--least", args.least_rays, "rays at one place that are asked about together; fewer go on alone")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--bounces", scene.bounces, "diffuse bounces after the primary ray, at most")
      ->capture_default_str();
  command->add_option("--seed", scene.seed, "seed of every random number")->capture_default_str();
  command->add_option("--leaf", scene.leaf_triangles, "triangles in a leaf, at most")->capture_default_str();
  command->add_option("--threads", scene.threads, "0: one for each core")->capture_default_str();
  command->callback([&] { parsed.exit_code = paper_packets_command(args); });
}

void add_paper_raybox(CLI::App& paper, Parsed& parsed) {
  auto* command =
      paper.add_subcommand("raybox", "ray-box culling: Tables 2 and 3 and the numbers of Figs. 4 to 7 as Markdown");
  PaperArgs& args = parsed.paper_raybox;
  SceneArgs& scene = args.scene;
  scene.spp = 0;
  command->add_option("scene", scene.scenes, "gen:balls, killeroo, buddha or sponza; none: all that are at hand");
  add_index_option(*command, scene);
  command->add_flag("--quick", args.quick, "a fifth of the paper's width and height, and 1 sample a pixel");
  command->add_option("--spp", scene.spp, "samples per pixel, instead of the paper's");
  command->add_option("--seed", scene.seed, "seed of every random number")->capture_default_str();
  command->add_option("--threads", scene.threads, "0: one for each core")->capture_default_str();
  command->callback([&] { parsed.exit_code = paper_raybox_command(args); });
}

/// Behind the others, whose defaults it takes.
void add_paper_all(CLI::App& paper, Parsed& parsed) {
  auto* command = paper.add_subcommand(
      "all", "all four: subspace, ray-box and packet culling, and ray-distribution-aware trees, published beside ours");
  PaperAllArgs& args = parsed.paper_all;
  command->add_flag("--quick", args.quick, "the quick setting of each, and a quarter of the packets' rays");
  command->add_option("--index", args.index,
                      "list of scenes, NAME PATH on each line; without it build/scenes/index.txt if it is there");
  command->add_option("--page", args.page,
                      "Markdown page to write into as well, between <!-- begin: NAME --> and <!-- end: NAME -->, NAME "
                      "being paper, raybox, packets and raydist");
  command->add_option("--out", args.output, "folder for plots and their data")->capture_default_str();
  command->add_option("--threads", args.threads, "0: one for each core")->capture_default_str();
  command->callback([&] {
    args.subspace = parsed.paper;
    args.raybox = parsed.paper_raybox;
    args.raydist = parsed.paper_raydist;
    args.packets = parsed.paper_packets;
    parsed.exit_code = paper_all_command(args);
  });
}

void add_paper(CLI::App& app, Parsed& parsed) {
  auto* command =
      app.add_subcommand("paper", "the evaluation of a paper with our scenes, published values beside ours");
  command->require_subcommand(1);
  add_paper_packets(*command, parsed);
  auto* subspace = command->add_subcommand(
      "subspace", "subspace culling: Tables 1 to 3 and Fig. 8 as Markdown, plots and their data in --out");
  PaperArgs& args = parsed.paper;
  SceneArgs& scene = args.scene;
  scene.size.clear();
  scene.spp = 0;
  subspace->add_option("scene", scene.scenes, "scenes: names of the index, files or generated ones; none: all");
  add_index_option(*subspace, scene);
  subspace->add_flag("--quick", args.quick, "160x90 pixels and 1 sample instead of the paper's 960x540 and 16");
  subspace->add_option("--out", args.output, "folder to write to")->capture_default_str();
  subspace->add_option("--size", scene.size, "picture size in pixels, WxH");
  subspace->add_option("--spp", scene.spp, "samples per pixel");
  subspace->add_option("--bounces", scene.bounces, "diffuse bounces after the primary ray, at most")
      ->capture_default_str();
  subspace->add_option("--seed", scene.seed, "seed of every random number")->capture_default_str();
  subspace->add_option("--turn", scene.turn, "degrees X,Y,Z by which scene and camera are turned about the axes");
  add_model_options(*subspace, scene);
  subspace->add_option("--leaf", scene.leaf_triangles, "triangles in a leaf, at most")->capture_default_str();
  subspace->add_option("--threads", scene.threads, "0: one for each core")->capture_default_str();
  subspace->callback([&] { parsed.exit_code = paper_subspace_command(args); });
  add_paper_raydist(*command, parsed);
  add_paper_raybox(*command, parsed);
  add_paper_all(*command, parsed);
}

void add_trace(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("trace", "look into trace files");
  command->require_subcommand(1);
  auto* info = command->add_subcommand("info", "how it was made, what it holds");
  info->add_option("trace", parsed.trace.trace, "trace file")->required();
  info->callback([&] { parsed.exit_code = trace_info_command(parsed.trace); });
  auto* head = command->add_subcommand("head", "print rays with their hits and steps");
  head->add_option("trace", parsed.trace.trace, "trace file")->required();
  head->add_option("--first", parsed.trace.first_ray, "first ray")->capture_default_str();
  head->add_option("--rays", parsed.trace.rays, "number of rays")->capture_default_str();
  head->callback([&] { parsed.exit_code = trace_head_command(parsed.trace); });
  auto* slice = command->add_subcommand("slice", "copy some rays into a trace of their own");
  slice->add_option("trace", parsed.trace.trace, "trace file")->required();
  slice->add_option("-o,--output", parsed.trace.output, "trace file to write")->required();
  slice->add_option("--first", parsed.trace.first_ray, "first ray")->capture_default_str();
  slice->add_option("--rays", parsed.trace.rays, "number of rays")->capture_default_str();
  slice->callback([&] { parsed.exit_code = trace_slice_command(parsed.trace); });
  auto* areas = command->add_subcommand(
      "areas", "find where its rays run to a light, and what trees of their own for these areas would save");
  areas->add_option("trace", parsed.trace.trace, "trace file")->required();
  areas->callback([&] { parsed.exit_code = trace_areas_command(parsed.trace); });
}

void add_config(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand("config", "the unit's parameters");
  command->require_subcommand(1);
  auto* show = command->add_subcommand("show", "the resolved configuration as TOML, every parameter documented");
  add_unit_options(*show, parsed.config);
  show->add_flag("--plain", parsed.config_plain, "values only");
  show->callback([&] { parsed.exit_code = config_show_command(parsed.config, parsed.config_plain); });
}

void add_bench(CLI::App& app, Parsed& parsed) {
  parsed.bench.unit.mode = parsed.bench.unit.source = "all";
  auto* command = app.add_subcommand("bench", "speed of the unit on a trace, in every mode, exec and replay");
  command->add_option("trace", parsed.bench.trace, "trace file")->required();
  add_unit_options(*command, parsed.bench.unit);
  command->add_option("--repeats", parsed.bench.repeats, "runs of each; the median is printed")->capture_default_str();
  command->callback([&] { parsed.exit_code = bench_command(parsed.bench); });
}

void add_check(CLI::App& app, Parsed& parsed) {
  auto* command = app.add_subcommand(
      "check", "hard cases by the million, judged by exact arithmetic: no hit may be lost, whatever answers");
  CheckArgs& args = parsed.check;
  command
      ->add_option("--engine", args.engine,
                   "what answers: reference, untimed; cycle: the timed unit; rtl: the unit in gates")
      ->capture_default_str();
  command->add_option("--budget", args.budget, "how long: 1000000 cases, 60s or 5m")->capture_default_str();
  command->add_option("--seed", args.seed, "seed of every random number; 0: a fresh one, which is printed")
      ->capture_default_str();
  command->add_option("--generator", args.generators, "only these: NAME,...; --list prints all")->delimiter(',');
  command->add_option("--scene", args.scene, "only this scene of each generator, as a failure names it")
      ->check(at_least(0));
  command->add_option("--design,--designs", args.designs, "mask-test designs, drawn for each scene; none: all");
  command->add_option("--r", args.resolution, "R: cells per axis of an object mask; 0: drawn from 2..8")
      ->capture_default_str();
  command->add_option("--r-ray", args.ray_resolution, "R_ray: cells per axis of the ray's key; 0: drawn from R on")
      ->capture_default_str();
  command->add_option("--l", args.levels, "L: levels below from which masks are made, 1..5 or inf; without it drawn");
  command
      ->add_option("--box-bits", args.box_bits,
                   "of each coordinate of a node's boxes: 32, 16, 12 or 8; 0: drawn, mostly 32")
      ->capture_default_str();
  command->add_option("--threads", args.threads, "0: one for each core; counts do not depend on it")
      ->capture_default_str();
  command->add_option("--json", args.json_path, "write the result here");
  command->add_option("--failures", args.failures,
                      "folder for failing cases: each a trace of one ray, which `run` replays, and its commands");
  command->add_option("--max-failures", args.kept_failures, "failing cases that are kept")->capture_default_str();
  command->add_flag(
      "--compare", args.compare,
      "what the paper's Algorithm 1 in plain binary32 and padding by an epsilon lose, beside the safe forms");
  command->add_flag("--packets", args.packets,
                    "random packets of rays instead: what every packet culling method says of boxes, triangles and "
                    "spheres; a case is a packet");
  command->add_flag("--list", args.list, "print the generators, and do nothing else");
  command->callback([&] { parsed.exit_code = check_command(args); });
}

std::string typed_command(int argc, const char* const* argv) {
  std::string text = "ctusim";
  for (int i = 1; i < argc; ++i) text += fmt::format(" {}", argv[i]);
  return text;
}

constexpr int kBadUsage = 2;

}  // namespace

int run_cli(int argc, const char* const* argv) {
  CLI::App app{"ctusim: cycle-level simulator of a culling traversal unit"};
  app.set_version_flag("--version", tool_version());
  app.require_subcommand(1);
  Parsed parsed;
  parsed.run.command = parsed.check.command = typed_command(argc, argv);
  add_record(app, parsed);
  add_run(app, parsed);
  add_compare(app, parsed);
  add_culling(app, parsed);
  add_metamorph(app, parsed);
  add_decide(app, parsed);
  add_precision(app, parsed);
  add_packets(app, parsed);
  add_compression(app, parsed);
  add_heatmap(app, parsed);
  add_tables(app, parsed);
  add_area(app, parsed);
  add_paper(app, parsed);
  add_trace(app, parsed);
  add_config(app, parsed);
  add_bench(app, parsed);
  add_check(app, parsed);
  parsed.ladder.command = parsed.run.command;
  ladder::add_ladder(app, parsed.ladder, parsed.exit_code);
  sweep::add_sweep(app, parsed.sweep, parsed.exit_code);
  report::add_report(app, parsed.report, parsed.exit_code);
  tailor::add_tailor(app, parsed.tailor, parsed.exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : kBadUsage;
  }
  return parsed.exit_code;
}

}  // namespace ctu::sim
