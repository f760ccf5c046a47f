// `ctusim record` and `ctusim trace`: making traces and looking into them.
#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/reference/packet_walk.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/culling_decision.h"
#include "sim/loaded_trace.h"
#include "sim/progress.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "traces/recorder.h"
#include "traces/slice.h"

namespace ctu::sim {
namespace {

constexpr int kPacketEntries = 8;  // where nobody says otherwise

void print_designs(const std::vector<traces::DesignCounts>& designs) {
  double base = 0;
  for (const auto& row : designs)
    if (row.design == cull::Design::None) base = row.counts.intersections_per_ray();
  fmt::print("{:<14}{:>14}{:>10}{:>10}{:>12}{:>10}\n", "mask test", "inters./ray", "of none", "culled", "uncertain",
             "changed");
  for (const auto& row : designs) {
    const double work = row.counts.intersections_per_ray();
    fmt::print("{:<14}{:>14.3f}{:>10}{:>8.1f} %{:>12}{:>10}\n", to_string(row.design), work,
               base > 0 ? fmt::format("{:.1f} %", 100 * work / base) : "-", 100 * row.counts.culled_share(),
               row.counts.uncertain, row.different_hits);
  }
}

void print_differences(const std::vector<traces::Difference>& differences) {
  for (const auto& d : differences)
    fmt::print("changed: ray {} with {}: primitive {} at {:a} became {} at {:a}\n", d.ray, to_string(d.design),
               d.expected.primitive, d.expected.t, static_cast<std::int32_t>(d.culled.primitive), d.culled.t);
}

void print_culling(const traces::CullingChoice& said) {
  fmt::print("culling: {} for {} ({})\n", said.choice, said.design, said.why);
  if (said.forecasts.empty()) return;
  fmt::print("{:<14}{:>14}{:>14}{:>18}{:>12}{:>10}   forecast from {} rays\n", "masks", "inters./ray", "cycles/ray",
             "nodes with masks", "bytes each", "image MB", said.pilot_rays);
  for (const traces::CullingForecast& row : said.forecasts)
    fmt::print("{:<14}{:>14.3f}{:>14.3f}{:>18}{:>12}{:>10.2f}\n", row.name, row.intersections_per_ray,
               row.cycles_per_ray, row.masked_nodes, row.masked_nodes == 0 ? 0 : row.node_bytes,
               double(row.image_bytes) / 1e6);
}

void print_step(const reference::Step& step, const accel::Bvh4& bvh) {
  if (step.is_leaf()) {
    const int count = accel::leaf_count(step.ref), tested = step.triangles_tested();
    fmt::print("    leaf  triangles {}..{}{}{}\n", accel::leaf_first(step.ref),
               accel::leaf_first(step.ref) + static_cast<unsigned>(count) - 1,
               tested < count ? fmt::format(", {} tested", tested) : "",
               step.became_best() != 0 ? fmt::format(", hit by mask {:#x}", step.became_best()) : "");
    return;
  }
  std::string order;
  for (unsigned i = 0, left = step.survivors(); left != 0; left &= left - 1, ++i)
    order += fmt::format(" {:#x}", bvh.nodes[step.ref].child[step.survivor(static_cast<int>(i))]);
  fmt::print("    node  {:<9} box hits {:04b} passed {:04b}{} ->{}\n", step.ref, step.box_hits(), step.survivors(),
             step.dropped != 0 ? fmt::format(" after {} dropped", step.dropped) : "", order);
}

/// What a packet visited, before its first ray's steps.
void print_packet(const reference::RayBlock& block, std::size_t ray) {
  const reference::PacketList& list = block.packets;
  const std::uint64_t p = list.packet_of(ray);
  if (list.first_ray[p] != ray) return;
  fmt::print("  packet of {} rays\n", list.first_ray[p + 1] - list.first_ray[p]);
  for (std::uint64_t i = list.first_visit[p]; i < list.first_visit[p + 1]; ++i)
    fmt::print("    node  {:<9} some meet {:04b} all meet {:04b}\n", list.visits[i].node, list.visits[i].hit(),
               list.visits[i].sure());
  for (std::uint64_t i = list.first_entry[p]; i < list.first_entry[p + 1]; ++i)
    fmt::print("    entry {}\n", list.entries[i]);
}

/// The first design whose steps the trace holds.
std::optional<cull::Design> stored_design(const traces::Manifest& manifest) {
  for (const auto& row : manifest.designs)
    if (row.stored) return row.design;
  return std::nullopt;
}

/// How the rays travel.
traces::RayPackets packets_of(const RecordArgs& args) {
  traces::RayPackets packets;
  if (args.packets == 0) {
    const bool says_how = args.packet_entries || args.packet_window || !args.packet_forming.empty();
    if (says_how) throw Error("--packet-*", "there are no packets", "add --packets RAYS, or leave it out");
    return packets;
  }
  if (args.culling == "auto")
    throw Error("--packets", "--culling auto foretells rays that travel alone", "give --culling on or off");
  packets.plan = {args.packets, args.packet_entries.value_or(kPacketEntries)};
  packets.window = args.packet_window.value_or(std::max(packets.window, args.packets));
  if (!args.packet_forming.empty()) {
    const auto forming = reference::forming_from_string(args.packet_forming);
    if (!forming)
      throw Error("--packet-forming", fmt::format("\"{}\" is no way to form packets", args.packet_forming),
                  "give order, direction or origin");
    packets.forming = *forming;
  }
  reference::check(packets.plan);
  reference::check(packets.how());
  return packets;
}

/// What `record` has beside the options of every scene.
traces::RecordOptions recorder_options(const RecordArgs& args) {
  traces::RecordOptions options = record_options(args.scene);
  if (args.culling != "on" && args.culling != "off" && args.culling != "auto")
    throw Error("--culling", fmt::format("\"{}\" is not on, off or auto", args.culling), "give on, off or auto");
  if (args.culling != "auto" && (!args.unit.config_path.empty() || !args.unit.sets.empty()))
    throw Error("--config, --set", "a recording is the same for every unit", "leave them out, or give --culling auto");
  options.with_masks = args.culling != "off";
  options.strip_full = args.strip_full;
  if (!options.with_masks && options.strip_full)
    throw Error("--strip-full", "without culling there are no masks to strip", "leave it out, or give --culling on");
  if (!options.with_masks && options.masks.entries != 0)
    throw Error("--compress", "without culling there are no masks to compress", "leave it out, or give --culling on");
  if (!args.designs.empty())
    options.designs = parse_designs(args.designs);
  else if (!options.with_masks)
    options.designs = {cull::Design::None};
  for (const cull::Design design : options.designs)
    if (!options.with_masks && design != cull::Design::None)
      throw Error("--designs", fmt::format("{} needs masks, and culling is off", to_string(design)),
                  "give --designs none, or --culling on");
  const auto check_alignment = [](const char* option, std::uint32_t bytes) {
    try {
      accel::validate({.node_alignment_bytes = bytes});
    } catch (const Error& problem) {
      throw Error(option, fmt::format("{} bytes are no alignment", bytes), problem.remedy());
    }
  };
  check_alignment("--node-align", args.node_alignment_bytes);
  check_alignment("--triangle-align", args.triangle_alignment_bytes);
  options.layout.node_alignment_bytes = args.node_alignment_bytes;
  options.layout.triangle_alignment_bytes = args.triangle_alignment_bytes;
  options.packets = packets_of(args);
  options.trees.most_areas = args.trees;
  traces::check(options.trees);
  if (options.trees.any() && args.culling == "auto")
    throw Error("--trees", "--culling auto foretells rays that all walk one tree", "give --culling on or off");
  require_box_bits(args.box_bits);
  options.layout.box_bits = args.box_bits;
  options.layout.primitive_boxes = args.primitive_boxes;
  options.strand_thickness = static_cast<float>(args.scene.strand_thickness);
  return options;
}

/// The trace of a scene whose masks are chosen for the unit; what was chosen and why is printed.
traces::RecordSummary record_chosen(const scene::Scene& scene, traces::RecordOptions options, const RecordArgs& args,
                                    const pipeline::UnitConfig& config, const traces::RecordProgress& progress) {
  const CullingDecision decision =
      decide_culling(scene, traces::build_tree(scene, options), options, {.config = config});
  if (!decision.with_masks) {
    options.with_masks = options.strip_full = false;
    options.designs = {cull::Design::None};
    options.masks.entries = 0;
  }
  print_culling(decision.tree.culling);
  return traces::record(scene, options, decision.tree, args.output, progress);
}

std::string describe_masks(const traces::TraceReader& reader) {
  const cull::MaskOptions& masks = reader.manifest().masks;
  if (reader.manifest().image.shape.layout.mask_bits == 0) return "none; culling is off";
  std::string text = fmt::format("R {}, R_ray {}, L {}", masks.resolution, masks.ray_resolution,
                                 masks.levels == cull::kUnlimitedLevels ? "inf" : std::to_string(masks.levels));
  if (const auto& lut = reader.compression())
    text += fmt::format("; indices of {} bits into a compression LUT of {} entries ({} asked for, {})",
                        lut->index_bits(), lut->entries(), masks.entries, to_string(masks.selection));
  return text;
}

}  // namespace

int record_command(const RecordArgs& args) {
  const traces::RecordOptions options = recorder_options(args);
  const pipeline::UnitConfig config = load_config(args.unit.config_path, args.unit.sets);
  if (args.culling == "auto") require_possible(config.mask_test.design, options.masks);
  const scene::Scene scene = load_scene(args.scene, args.scene.scenes.front());
  traces::RecordSummary summary;
  {
    Progress bar("recording", 0, "paths");
    const auto progress = [&](std::uint64_t done, std::uint64_t) { bar.update(done); };
    summary = args.culling == "auto" ? record_chosen(scene, options, args, config, progress)
                                     : traces::record(scene, options, args.output, progress);
  }
  fmt::print("{}: {} triangles, {} nodes, {:.1f} MB image; {} rays, {:.1f} MB, hash {}\n", args.output,
             summary.triangles, summary.nodes, double(summary.image_bytes) / 1e6, summary.rays,
             double(summary.file_bytes) / 1e6, summary.hash);
  if (summary.packets != 0)
    fmt::print("{} packets, {:.2f} nodes visited and {:.2f} entries each\n", summary.packets,
               double(summary.packet_visits) / double(summary.packets),
               double(summary.packet_entries) / double(summary.packets));
  if (options.trees.any())
    fmt::print("{} local trees; {} rays walk one, {:.3f} unculled tests a ray where one tree takes {:.3f}\n",
               summary.trees - 1, summary.local_rays, double(summary.own_tests) / double(summary.rays),
               double(summary.global_tests) / double(summary.rays));
  if (summary.bare_nodes != 0)
    fmt::print("{} nodes carry no masks, because all of theirs are full\n", summary.bare_nodes);
  if (summary.compression_entries != 0)
    fmt::print("nodes of {} bytes; masks are indices into {} entries, selected in {:.2f} s\n",
               summary.node_stride_bytes, summary.compression_entries, summary.compression_seconds);
  fmt::print("tree {:.2f} s, masks {:.2f} s, rays {:.2f} s\n", summary.build_seconds, summary.mask_seconds,
             summary.trace_seconds);
  print_designs(summary.designs);
  print_differences(summary.differences);
  return 0;
}

int trace_info_command(const TraceArgs& args) {
  const traces::TraceReader reader(args.trace);
  const traces::Manifest& m = reader.manifest();
  const auto row = [](std::string_view name, const std::string& value) { fmt::print("{:<16}{}\n", name, value); };
  row("trace", fmt::format("{}, {:.2f} MB, hash {}", args.trace, double(reader.size_bytes()) / 1e6, reader.hash()));
  row("written by", m.tool);
  row("scene", fmt::format("{} ({}), {} triangles, hash {}", m.scene.name, m.scene.report.format, m.scene.triangles,
                           m.scene.hash));
  row("rays", fmt::format("{} {} in {} blocks; {}x{} pixels, {} samples, seed {}", reader.rays(),
                          traces::to_string(m.rays.kind), reader.blocks(), m.rays.width, m.rays.height,
                          m.rays.samples_per_pixel, m.rays.seed));
  if (m.packets.any())
    row("packets", fmt::format("of {} rays, up to {} entries; rays of a window of {} by {}", m.packets.plan.size,
                               m.packets.plan.most_entries, m.packets.window, reference::to_string(m.packets.forming)));
  if (m.trees.any())
    row("trees", fmt::format("{} in the image, {} of them local; up to {} asked for", m.image.shape.trees(),
                             m.image.shape.trees() - 1, m.trees.most_areas));
  row("masks", describe_masks(reader));
  if (!m.culling.choice.empty()) print_culling(m.culling);
  if (const std::uint32_t bare = m.image.shape.layout.bare_nodes; bare != 0)
    row("bare nodes", fmt::format("{} of {} bytes without masks: all of theirs are full", bare,
                                  m.image.shape.bare_node_stride_bytes));
  row("image", fmt::format("{} nodes of {} bytes, {} triangles of {} bytes, depth {}", m.image.shape.node_count,
                           m.image.shape.node_stride_bytes, m.image.shape.triangle_count,
                           m.image.shape.triangle_stride_bytes, m.image.shape.depth));
  if (m.image.shape.sphere_count != 0)
    row("spheres", fmt::format("{} of the triangles are spheres", m.image.shape.sphere_count));
  if (reader.has_primitive_boxes()) row("primitive boxes", "beside every primitive, for ray-box culling");
  if (const std::uint32_t bits = m.image.shape.layout.box_bits; bits != accel::kFullBoxBits)
    row("boxes", fmt::format("{} bits for each coordinate, in the frame of their node", bits));
  if (!m.cut_from.empty()) row("cut from", fmt::format("{}, from ray {}", m.cut_from, m.cut_first));
  print_designs(m.designs);
  print_differences(m.differences);
  reader.verify();
  fmt::print("every section agrees with its checksum\n");
  return 0;
}

int trace_head_command(const TraceArgs& args) {
  const LoadedTrace trace(args.trace);
  const traces::RayRange range = trace.range(args.first_ray, args.rays);
  const auto design = stored_design(trace.reader().manifest());
  const cull::MaskTester tester = trace.tester(design.value_or(cull::Design::None));
  traces::TraceFeed feed(trace.reader(), range, trace.bvh(), &trace.masks(), tester);
  fmt::print("steps with {}\n", to_string(tester.design()));
  while (const auto block = feed.next())
    for (std::size_t i = 0; i < block->rays.size(); ++i) {
      const auto& ray = block->rays[i];
      const auto& hit = block->expected[i];
      fmt::print("ray {} {} origin {} {} {} direction {} {} {} t [{}, {}]: {}\n", block->first_ray + i,
                 ray.kind == intersect::RayKind::AnyHit ? "any-hit" : "closest-hit", ray.origin.x, ray.origin.y,
                 ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.tmin, ray.tmax,
                 hit.primitive == intersect::kNoPrimitive
                     ? "miss"
                     : fmt::format("primitive {} at t {} u {} v {}", hit.primitive, hit.t, hit.u, hit.v));
      if (!block->trees.empty()) fmt::print("  walks tree {}\n", block->trees[i].tree);
      if (block->packets.packets() != 0) print_packet(*block, i);
      for (auto s = block->steps.first_step[i]; s < block->steps.first_step[i + 1]; ++s)
        print_step(block->steps.steps[s], trace.bvh());
    }
  return 0;
}

int trace_slice_command(const TraceArgs& args) {
  const traces::RayRange range = [&] {
    const LoadedTrace trace(args.trace);
    return trace.range(args.first_ray, args.rays);
  }();
  const std::string hash = traces::slice(args.trace, args.output, range);
  fmt::print("{}: {} rays, hash {}\n", args.output, range.last - range.first, hash);
  return 0;
}

}  // namespace ctu::sim
