#include "traces/recorder.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/parallel.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/packet_walk.h"
#include "model/reference/traversal.h"
#include "traces/mask_set.h"
#include "traces/ray_generator.h"
#include "traces/trace_writer.h"

namespace ctu::traces {
namespace {

using cull::Design;
using reference::StepList;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Whose tables stand for an event class: those of projection give mask-lut's masks bit for bit, and there is no R_ray
/// for which they would be too large or take long to make.
Design tables_of(Design event_class) { return event_class == Design::MaskLut ? Design::Projection : event_class; }

/// A design at work: its tables and its walk. `leaf_boxes` may be null.
struct Culler {
  Culler(Design d, bool store, const cull::MaskOptions& masks, const RecordedTree& tree,
         const std::vector<accel::PrimitiveBox>* leaf_boxes)
      : design(d),
        stored(store),
        tester(tables_of(d), masks),
        traversal(tree.bvh, &tree.masks.masks, tester, leaf_boxes, cull::RayBoxRule::OncePerLeaf) {}
  Design design;
  bool stored;
  cull::MaskTester tester;
  reference::Traversal traversal;
};

/// The designs asked for, each event class once, those to be stored first.
std::vector<std::pair<Design, bool>> designs_of(const RecordOptions& options) {
  std::vector<std::pair<Design, bool>> list;
  const auto add = [&](Design design, bool stored) {
    design = cull::event_class(design);
    if (std::none_of(list.begin(), list.end(), [&](const auto& entry) { return entry.first == design; }))
      list.emplace_back(design, stored);
  };
  for (const Design design : options.designs) add(design, true);
  for (const Design design : options.count_only) add(design, false);
  std::stable_partition(list.begin(), list.end(), [](const auto& entry) { return entry.second; });
  return list;
}

Manifest make_manifest(const scene::Scene& scene, const RecordOptions& options) {
  Manifest manifest;
  manifest.scene.name = scene.name;
  manifest.scene.hash = scene::content_hash(scene.mesh).hex();
  manifest.scene.strand_thickness = options.strand_thickness;
  manifest.scene.triangles = scene.mesh.triangles.size();
  manifest.scene.spheres = scene.mesh.spheres.size();
  manifest.scene.camera = scene.camera;
  manifest.scene.report = scene.report;
  manifest.rays = options.rays;
  manifest.packets = options.packets;
  manifest.build = options.build;
  manifest.masks = options.masks;
  for (const auto& [design, stored] : designs_of(options)) manifest.designs.push_back({design, stored, {}, 0});
  return manifest;
}

/// What one block of paths gives: its encoded columns, and its share of the counts.
struct Outcome {
  EncodedBlock block;
  std::vector<DesignCounts> designs;
  std::vector<Difference> differences;  ///< rays counted from the block's first
  std::uint64_t packets = 0, packet_visits = 0, packet_entries = 0;
};

/// The elements in another order.
template <class T>
std::vector<T> reordered(const std::vector<T>& all, const std::vector<std::uint32_t>& order) {
  std::vector<T> out;
  out.reserve(order.size());
  for (const std::uint32_t i : order) out.push_back(all[i]);
  return out;
}

/// Traces blocks of paths on any thread.
class BlockTracer {
 public:
  /// `expected`: without any culling. `ray_boxes`: the cullers have them.
  BlockTracer(const RayGenerator& generator, const std::vector<std::unique_ptr<Culler>>& cullers,
              const reference::Traversal& expected, const accel::Bvh4& bvh, const RayPackets& packets, bool ray_boxes)
      : generator_(generator),
        cullers_(cullers),
        expected_(expected),
        bvh_(bvh),
        packets_(packets),
        ray_boxes_(ray_boxes) {}

  Outcome trace(std::uint64_t first, std::uint64_t last, BlockEncoder& encoder) const {
    std::vector<intersect::Ray> rays;
    std::vector<intersect::Hit> hits;
    std::vector<StepList> steps(cullers_.size());
    StepList* without_culling = nullptr;  // filled on the way, as that walk gives the expected hits
    for (std::size_t i = 0; i < cullers_.size(); ++i)
      if (!culls(*cullers_[i]) && !packets_.any()) without_culling = &steps[i];
    const auto closest = [&](const intersect::Ray& ray, bool recorded) {
      return expected_.trace(ray, recorded ? without_culling : nullptr);
    };
    generator_.generate(first, last, closest, rays, hits);

    Outcome outcome;
    std::optional<reference::PacketWalk> packets;
    if (packets_.any()) {
      const std::vector<std::uint32_t> order = reference::packet_order(rays, packets_.how());
      rays = reordered(rays, order), hits = reordered(hits, order);
      packets.emplace(bvh_, packets_.plan, rays,
                      reference::cut_packets(static_cast<std::uint32_t>(rays.size()), packets_.plan.size));
      StepList unused;
      reference::expect_from_entries(rays, packets->trace(expected_, unused), hits);
      outcome.packets = packets->list().packets();
      outcome.packet_visits = packets->list().visits.size();
      outcome.packet_entries = packets->list().entries.size();
    }
    std::vector<StepList> stored;
    for (std::size_t i = 0; i < cullers_.size(); ++i) {
      const Culler& culler = *cullers_[i];
      DesignCounts counts{culler.design, culler.stored, {}, 0};
      if (packets)
        compare(culler.design, hits, packets->trace(culler.traversal, steps[i]), counts, outcome.differences);
      else if (culls(culler))
        compare(culler.design, hits, trace_alone(culler, rays, steps[i]), counts, outcome.differences);
      counts.counts = reference::count_steps(steps[i], 0, steps[i].rays());
      outcome.designs.push_back(counts);
      if (culler.stored)
        stored.push_back(std::move(steps[i]));
      else
        steps[i] = {};
    }
    outcome.block = packets ? encoder.encode(rays, hits, stored, packets->list()) : encoder.encode(rays, hits, stored);
    return outcome;
  }

 private:
  bool culls(const Culler& culler) const { return culler.design != Design::None || ray_boxes_; }

  static std::vector<intersect::Hit> trace_alone(const Culler& culler, const std::vector<intersect::Ray>& rays,
                                                 StepList& steps) {
    std::vector<intersect::Hit> hits;
    hits.reserve(rays.size());
    for (const intersect::Ray& ray : rays) hits.push_back(culler.traversal.trace(ray, &steps));
    return hits;
  }

  static void compare(Design design, const std::vector<intersect::Hit>& expected,
                      const std::vector<intersect::Hit>& hits, DesignCounts& counts,
                      std::vector<Difference>& differences) {
    for (std::size_t ray = 0; ray < hits.size(); ++ray) {
      if (same_bits(hits[ray], expected[ray])) continue;
      ++counts.different_hits;
      differences.push_back({design, ray, expected[ray], hits[ray]});
    }
  }

  const RayGenerator& generator_;
  const std::vector<std::unique_ptr<Culler>>& cullers_;
  const reference::Traversal& expected_;
  const accel::Bvh4& bvh_;
  const RayPackets& packets_;
  bool ray_boxes_;
};

/// Takes outcomes from many threads and writes them in order; a thread that is early waits, which bounds the memory.
class OrderedSink {
 public:
  OrderedSink(TraceWriter& writer, RecordSummary& summary) : writer_(writer), summary_(summary) {}

  template <class Progress>
  void put(std::uint64_t number, const Outcome& outcome, Progress&& progress) {
    std::unique_lock lock(mutex_);
    turn_.wait(lock, [&] { return next_ == number || failed_; });
    if (failed_) return;  // the thread that failed reports why
    try {
      for (std::size_t i = 0; i < outcome.designs.size(); ++i) {
        summary_.designs[i].counts += outcome.designs[i].counts;
        summary_.designs[i].different_hits += outcome.designs[i].different_hits;
      }
      for (Difference difference : outcome.differences) {
        if (summary_.differences.size() >= kMaxListedDifferences) break;
        difference.ray += summary_.rays;
        summary_.differences.push_back(difference);
      }
      summary_.packets += outcome.packets;
      summary_.packet_visits += outcome.packet_visits;
      summary_.packet_entries += outcome.packet_entries;
      writer_.add(outcome.block);
      summary_.rays += outcome.block.rays;
      progress();
    } catch (...) {
      fail();
      throw;
    }
    ++next_;
    turn_.notify_all();
  }

  /// A block that never comes must not keep the others waiting.
  void abandon() {
    const std::lock_guard lock(mutex_);
    fail();
  }

 private:
  void fail() {
    failed_ = true;
    turn_.notify_all();
  }

  TraceWriter& writer_;
  RecordSummary& summary_;
  std::mutex mutex_;
  std::condition_variable turn_;
  std::uint64_t next_ = 0;
  bool failed_ = false;
};

void check_options(const RecordOptions& options) {
  check(options.rays);
  if (options.packets.any()) {
    reference::check(options.packets.plan);
    reference::check(options.packets.how());
  }
  if (options.rays_per_block < 1 || options.rays_per_block > kMaxRaysPerBlock)
    throw Error("record", fmt::format("rays_per_block is {}", options.rays_per_block),
                fmt::format("give 1 to {}", kMaxRaysPerBlock));
  cull::validate(options.masks);
  accel::validate(options.layout);
  if (options.with_masks) return;
  if (options.strip_full) throw Error("record", "there are no masks to strip", "record with masks");
  if (options.masks.entries != 0) throw Error("record", "masks that are left out cannot be compressed", "ask for one");
  for (const auto& [design, stored] : designs_of(options))
    if (design != Design::None)
      throw Error("record", fmt::format("design {} without masks", cull::to_string(design)), "record design none only");
}

}  // namespace

RecordedTree build_tree(const scene::Scene& scene, const RecordOptions& options) {
  check_options(options);
  RecordedTree tree;
  auto start = std::chrono::steady_clock::now();
  tree.bvh = accel::build(scene.mesh, options.build);
  if (options.layout.box_bits != accel::kFullBoxBits)
    accel::quantize_boxes(tree.bvh, options.layout.box_bits, options.threads);
  tree.build_seconds = seconds_since(start);
  if (!options.with_masks) return tree;
  start = std::chrono::steady_clock::now();
  cull::ObjectMasks masks = cull::build_object_masks(tree.bvh, options.masks, options.threads);
  tree.mask_seconds = seconds_since(start);
  start = std::chrono::steady_clock::now();
  tree.masks = mask_set(tree.bvh, std::move(masks), options.masks, options.threads);
  tree.compression_seconds = seconds_since(start);
  return tree;
}

void strip_full(RecordedTree& tree) { tree.bare_nodes = put_full_last(tree.bvh, tree.masks); }

RecordSummary record(const scene::Scene& scene, const RecordOptions& options, const std::string& path,
                     const RecordProgress& progress) {
  RecordedTree tree = build_tree(scene, options);
  if (options.strip_full) strip_full(tree);
  return record(scene, options, tree, path, progress);
}

RecordSummary record(const scene::Scene& scene, const RecordOptions& options, const RecordedTree& tree,
                     const std::string& path, const RecordProgress& progress) {
  check_options(options);
  const RayGenerator generator(scene, options.rays);
  Manifest manifest = make_manifest(scene, options);
  manifest.culling = tree.culling;
  RecordSummary summary;
  summary.designs = manifest.designs;
  summary.build_seconds = tree.build_seconds;
  summary.mask_seconds = tree.mask_seconds;
  summary.compression_seconds = tree.compression_seconds;
  summary.compression_entries = tree.masks.lut ? tree.masks.lut->entries() : 0;

  accel::ImageLayout layout = options.layout;
  layout.bare_nodes = summary.bare_nodes = tree.bare_nodes;
  const auto start = std::chrono::steady_clock::now();
  const auto make_writer = [&] {  // the image is large and needed only here
    const accel::Image image = image_of(tree.bvh, options.with_masks ? &tree.masks : nullptr, layout);
    summary.image_bytes = image.bytes.size();
    summary.nodes = image.node_count;
    summary.node_stride_bytes = image.node_stride_bytes;
    summary.triangles = image.triangle_count;
    return std::make_unique<TraceWriter>(path, manifest, image, tree.masks.lut.get());
  };
  const std::unique_ptr<TraceWriter> writer = make_writer();

  const cull::MaskTester no_culling(Design::None, options.masks);
  const reference::Traversal expected(tree.bvh, nullptr, no_culling);
  std::vector<accel::PrimitiveBox> leaf_boxes;
  if (layout.primitive_boxes) leaf_boxes = reference::leaf_boxes(tree.bvh);
  std::vector<std::unique_ptr<Culler>> cullers;
  for (const DesignCounts& entry : manifest.designs)
    cullers.push_back(std::make_unique<Culler>(entry.design, entry.stored, options.masks, tree,
                                               layout.primitive_boxes ? &leaf_boxes : nullptr));
  const BlockTracer tracer(generator, cullers, expected, tree.bvh, options.packets, layout.primitive_boxes);

  OrderedSink sink(*writer, summary);
  const std::uint64_t paths_per_block = std::max(1u, options.rays_per_block / generator.max_rays_per_path());
  parallel_chunks(generator.paths(), paths_per_block, options.threads, [&](std::size_t first, std::size_t last) {
    try {
      BlockEncoder encoder = writer->make_encoder();
      const Outcome outcome = tracer.trace(first, last, encoder);
      sink.put(first / paths_per_block, outcome, [&] {
        if (progress) progress(last, generator.paths());
      });
    } catch (...) {
      sink.abandon();
      throw;
    }
  });
  summary.hash = writer->finish(summary.designs, summary.differences);
  summary.trace_seconds = seconds_since(start);
  summary.file_bytes = std::filesystem::file_size(path);
  return summary;
}

}  // namespace ctu::traces
