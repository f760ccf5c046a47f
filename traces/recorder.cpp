#include "traces/recorder.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "model/accel/forest.h"
#include "model/base/error.h"
#include "model/base/parallel.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/block_walk.h"
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
  manifest.trees = options.trees;
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
  std::uint64_t local_rays = 0, own_tests = 0, global_tests = 0;
};

/// The elements in another order.
template <class T>
std::vector<T> reordered(const std::vector<T>& all, const std::vector<std::uint32_t>& order) {
  std::vector<T> out;
  out.reserve(all.size());
  for (const std::uint32_t i : order) out.push_back(all[i]);
  return out;
}

/// Traces blocks of paths on any thread.
class BlockTracer {
 public:
  /// `expected`: without any culling. `local`: null where all rays walk one tree.
  BlockTracer(const RayGenerator& generator, const std::vector<std::unique_ptr<Culler>>& cullers,
              const reference::Traversal& expected, const LocalTrees* local, const RecordOptions& options)
      : generator_(generator),
        cullers_(cullers),
        expected_(expected),
        local_(local),
        packets_(options.packets),
        ray_boxes_(options.layout.primitive_boxes) {}

  Outcome trace(std::uint64_t first, std::uint64_t last, BlockEncoder& encoder) const {
    std::vector<StepList> steps(cullers_.size());
    StepList* without_culling = nullptr;  // filled on the way, as that walk gives the expected hits
    for (std::size_t i = 0; i < cullers_.size(); ++i)
      if (!walks_otherwise(*cullers_[i])) without_culling = &steps[i];
    reference::RayBlock block = generate(first, last, without_culling);

    Outcome outcome;
    std::vector<StepList> stored;
    for (std::size_t i = 0; i < cullers_.size(); ++i) {
      const Culler& culler = *cullers_[i];
      DesignCounts counts{culler.design, culler.stored, {}, 0};
      if (walks_otherwise(culler)) {
        compare(culler.design, block.expected, reference::walk_block(culler.traversal, packets_.plan, block), counts,
                outcome.differences);
        steps[i] = std::move(block.steps);
      }
      counts.counts = reference::count_steps(steps[i], 0, steps[i].rays());
      outcome.designs.push_back(counts);
      if (culler.stored) stored.push_back(std::move(steps[i]));
      steps[i] = {};
    }
    count(block, outcome);
    outcome.block = encoder.encode(block, stored);
    return outcome;
  }

 private:
  /// Rays are not each alone in the tree over the whole scene.
  bool diverts() const { return packets_.any() || local_ != nullptr; }
  /// Its walk is another than that which finds the expected hits.
  bool walks_otherwise(const Culler& culler) const { return culler.design != Design::None || ray_boxes_ || diverts(); }

  /// The rays as they travel, with what they are expected to find.
  reference::RayBlock generate(std::uint64_t first, std::uint64_t last, StepList* without_culling) const {
    reference::RayBlock block;
    const auto closest = [&](const intersect::Ray& ray, bool recorded) {
      return expected_.trace(ray, recorded ? without_culling : nullptr);
    };
    generator_.generate(first, last, closest, block.rays, block.expected);
    if (local_ != nullptr) block.trees = local_->choose(expected_, block.rays);
    if (packets_.any()) form_packets(block);
    if (diverts()) {
      const std::vector<intersect::Hit> found = reference::walk_block(expected_, packets_.plan, block);
      reference::expect_any_hits_found(block.rays, found, block.expected);
    }
    return block;
  }

  void form_packets(reference::RayBlock& block) const {
    std::vector<std::uint32_t> order = reference::packet_order(block.rays, packets_.how());
    if (!block.trees.empty()) {
      put_trees_together(block.trees, packets_.window, order);
      block.trees = reordered(block.trees, order);
    }
    block.rays = reordered(block.rays, order);
    block.expected = reordered(block.expected, order);
    block.packets =
        reference::cut_packets(static_cast<std::uint32_t>(block.rays.size()), packets_.plan.size, block.trees);
  }

  static void count(const reference::RayBlock& block, Outcome& outcome) {
    outcome.packets = block.packets.packets();
    outcome.packet_visits = block.packets.visits.size();
    outcome.packet_entries = block.packets.entries.size();
    for (const reference::RayTree& tree : block.trees) {
      outcome.local_rays += tree.tree != 0;
      outcome.own_tests += tree.own_tests;
      outcome.global_tests += tree.global_tests;
    }
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
  const LocalTrees* local_;
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
      summary_.local_rays += outcome.local_rays;
      summary_.own_tests += outcome.own_tests;
      summary_.global_tests += outcome.global_tests;
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
  check(options.trees);
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

/// Behind the tree over the whole scene.
void add_local_trees(const scene::Scene& scene, const RecordOptions& options, RecordedTree& tree) {
  const RayGenerator generator(scene, options.rays);
  tree.local = std::make_shared<const LocalTrees>(scene, generator, tree.bvh, options.trees, options.build);
  for (std::uint32_t i = 0; i < tree.local->count(); ++i) accel::append_tree(tree.bvh, tree.local->tree(i));
}

}  // namespace

RecordedTree build_tree(const scene::Scene& scene, const RecordOptions& options) {
  check_options(options);
  RecordedTree tree;
  auto start = std::chrono::steady_clock::now();
  tree.bvh = accel::build(scene.mesh, options.build);
  if (options.trees.any()) add_local_trees(scene, options, tree);
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
    summary.trees = image.trees();
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
  const BlockTracer tracer(generator, cullers, expected, tree.local.get(), options);

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
