// The subcommands of `ctusim`: what each is given (filled by cli.cpp) and the function that does it. Each returns the
// exit code 0 (done) or 1 (a check failed); mistakes of the user are Errors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ctu::sim {

/// Which rays, on which tree, with which masks: shared by every command that starts from a scene.
struct SceneArgs {
  std::vector<std::string> scenes;
  std::string index;  ///< file that names scenes, for commands that take several
  double strand_thickness = 0;
  int strand_sides = 2;              ///< 2: ribbons
  std::vector<std::string> without;  ///< files that the scene names and that are left out; * stands for any letters
  std::string eye, target, up;       ///< "x,y,z"; empty: as the scene says
  double vertical_fov = 0;           ///< degrees; 0: as the scene says
  std::string turn;                  ///< "x,y,z" degrees about the axes, scene and camera together
  std::string rays = "diffuse";      ///< `culling` also takes "all"
  std::string size = "256x256";
  std::uint32_t spp = 1;
  std::uint32_t bounces = 4;
  std::uint64_t seed = 1;
  std::uint64_t count = 0;
  bool skip_primary = false;
  int resolution = 4;
  int ray_resolution = 0;  ///< 0: as resolution
  std::string levels = "inf";
  std::optional<int> compress;  ///< entries of the compression LUT; none: masks are not compressed
  std::string selection;        ///< of these entries; empty: MaskOptions' own
  int leaf_triangles = 4;
  double triangle_cost = 1;  ///< of a triangle test in the builder's SAH, relative to a 4-wide box test
  int threads = 0;           ///< 0: all
};

/// Which unit: shared by every command that runs it.
struct UnitArgs {
  std::string config_path;
  std::vector<std::string> sets;
  std::string mode = "batch";
  std::string source = "replay";
};

struct RecordArgs {
  SceneArgs scene;
  std::string output;
  std::string designs;         ///< empty: none,mask-lut,comparators, or none when culling is off
  std::string culling = "on";  ///< "off": nodes carry no masks; "auto": as pays on the unit
  UnitArgs unit;               ///< that auto decides for: its configuration
  bool strip_full = false;     ///< nodes whose masks are all full carry none
  std::uint32_t node_alignment_bytes = 4, triangle_alignment_bytes = 4;
  std::uint32_t box_bits = 32;  ///< of a coordinate of a node's boxes
  bool primitive_boxes = false;
  int trees = 0;                                     ///< local trees at most; 0: one tree for all rays
  int packets = 0;                                   ///< rays of a packet; 0: rays travel alone
  std::optional<int> packet_entries, packet_window;  ///< none: as RayPackets has it
  std::string packet_forming;                        ///< empty: as they come
};

struct RunArgs {
  std::string trace;
  UnitArgs unit;
  std::string engine = "cycle";
  std::string json_path;
  std::string waves_path, timeline_path, window;
  std::string energy_path;                                                ///< table of energies; empty: ours
  bool gives_mode = false, gives_source = false, gives_sampling = false;  ///< on the command line
  std::string error = "2%", confidence = "95%";                           ///< sampled
  std::uint64_t seed = 1;
  std::uint64_t first_ray = 0, rays = 0;  ///< rays 0: to the end
  std::string command;                    ///< as it was typed
};

struct CompareArgs {
  std::vector<std::string> traces;
  UnitArgs unit;
  std::string designs = "none,mask-lut,projection,comparators";
  bool markdown = false;
};

struct CullingArgs {
  SceneArgs scene;
  std::string designs = "ideal,mask-lut,comparators";
  bool markdown = false;
};

struct MetamorphArgs {
  SceneArgs scene;
  std::string designs = "ideal,mask-lut,projection,bit-table,dedup,comparators";
  std::vector<std::string> checks{"all"};
  std::uint64_t aimed = 20000;  ///< rays at edges and vertices, at most; 0: at all of them
  std::string json_path;
  bool markdown = false;
};

struct DecideArgs {
  SceneArgs scene;
  UnitArgs unit;
  std::uint64_t pilot_rays = 32768;
  bool markdown = false;
};

struct PrecisionArgs {
  SceneArgs scene;
  UnitArgs unit;
  std::string designs = "none,projection,comparators";
  std::string box_bits = "32,16,12,8";
  std::uint64_t rays = 20000;  ///< sampled, about so many; 0: all
  std::string output;          ///< folder for the plot and its data; empty: none
  bool markdown = false;
};

struct PacketsArgs {
  SceneArgs scene;  ///< `rays` also "all"
  UnitArgs unit;
  std::string sizes = "8,16,32,64", entries = "1,2,4,8,16";
  std::string forming = "order";
  int window = 1024;           ///< consecutive rays that packets are formed from
  std::uint64_t rays = 40000;  ///< sampled, about so many; 0: all
  bool markdown = false;
};

struct CompressionArgs {
  SceneArgs scene;
  bool ideas = false;  ///< rows for ideas that did not become a selection
  bool markdown = false;
};

struct HeatmapArgs {
  SceneArgs scene;
  std::string output;
  std::string design = "mask-lut";
  std::uint32_t range = 0;  ///< intersections at the bright end; 0: the 99th percentile without culling
};

struct TablesArgs {
  int resolution = 4;
  int ray_resolution = 0;  ///< 0: as resolution
  int entries = 0;         ///< of the compression LUT; 0: masks are not compressed
  int projection_tables = 3;
  bool markdown = false;
};

struct AreaArgs {
  UnitArgs unit;
  int resolution = 4;
  int ray_resolution = 0;                         ///< 0: as resolution
  int entries = 0;                                ///< of the compression LUT; 0: masks are not compressed
  std::uint32_t box_bits = 32;                    ///< of a coordinate of the image's boxes
  bool primitive_boxes = false, spheres = false;  ///< the image has them
  int packet_entries = 0;                         ///< of a packet at most; 0: rays travel alone
  int trees = 1;                                  ///< of the image
  std::string rtl, cache;                         ///< folders; empty: those of the source tree and of the user
  std::string yosys = "yosys";
  std::string stages;  ///< list; empty: all
  int threads = 0;     ///< 0: all
  bool fpga = false, json = false, markdown = false;
};

struct PaperArgs {
  SceneArgs scene;  ///< size empty and spp 0: as the paper, or as `quick` says
  bool quick = false;
  std::string output = "paper-subspace";  ///< folder
};

struct PaperPacketsArgs {
  SceneArgs scene;              ///< `rays` also "all"
  std::uint64_t sample = 8192;  ///< rays of each kind, about so many; 0: all
  int size = 16, window = 256;  ///< rays of a packet, and that packets are formed from
  std::string forming = "origin";
  int least_rays = 4;  ///< at one place; fewer go on alone
};

struct PaperAllArgs {
  PaperArgs subspace, raybox, raydist;  ///< their scenes and sizes are the defaults
  PaperPacketsArgs packets;
  bool quick = false;
  std::string index, page;                ///< page: Markdown, with a marked section for each paper; empty: none
  std::string output = "paper-subspace";  ///< folder
  int threads = 0;                        ///< 0: one for each core
};

struct TraceArgs {
  std::string trace;
  std::string output;  ///< slice
  std::uint64_t first_ray = 0, rays = 10;
};

struct BenchArgs {
  std::string trace;  ///< `unit.mode` and `unit.source` may be "all"
  UnitArgs unit;
  int repeats = 3;
};

struct CheckArgs {
  std::string engine = "reference";
  std::vector<std::string> generators;     ///< none: all
  std::string designs;                     ///< list; empty: all that the engine has
  int resolution = 0, ray_resolution = 0;  ///< 0: drawn for each scene
  std::string levels;                      ///< empty: drawn
  std::uint32_t box_bits = 0;              ///< 0: drawn
  std::string budget = "60s";
  std::uint64_t seed = 0;              ///< 0: a fresh one
  std::optional<std::uint64_t> scene;  ///< only this one of each generator
  int threads = 0;                     ///< 0: all
  std::string json_path;
  std::string failures;  ///< folder; empty: failing cases are printed only
  std::size_t kept_failures = 16;
  bool compare = false;  ///< naive forms of the node test with the safe ones
  bool packets = false;  ///< packet culling instead of an engine
  bool list = false;     ///< the generators, and nothing else
  std::string command;   ///< as it was typed
};

int record_command(const RecordArgs& args);
int run_command(const RunArgs& args);
int compare_command(const CompareArgs& args);
int culling_command(const CullingArgs& args);
int metamorph_command(const MetamorphArgs& args);
int decide_command(const DecideArgs& args);
int precision_command(const PrecisionArgs& args);
int packets_command(const PacketsArgs& args);
int compression_command(const CompressionArgs& args);
int heatmap_command(const HeatmapArgs& args);
int tables_command(const TablesArgs& args);
int area_command(const AreaArgs& args);
int paper_all_command(PaperAllArgs args);
int paper_packets_command(const PaperPacketsArgs& args);
int paper_subspace_command(const PaperArgs& args);
int paper_raydist_command(const PaperArgs& args);
int paper_raybox_command(const PaperArgs& args);
int trace_info_command(const TraceArgs& args);
int trace_head_command(const TraceArgs& args);
int trace_slice_command(const TraceArgs& args);
int trace_areas_command(const TraceArgs& args);
int config_show_command(const UnitArgs& args, bool plain);
int check_command(const CheckArgs& args);
int bench_command(const BenchArgs& args);

}  // namespace ctu::sim
