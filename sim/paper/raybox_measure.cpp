#include "sim/paper/raybox_measure.h"

#include <memory>
#include <mutex>

#include "model/accel/build.h"
#include "model/accel/kd_build.h"
#include "model/base/parallel.h"
#include "sim/hit_judge.h"
#include "sim/paper/published_raybox.h"
#include "sim/stopwatch.h"

namespace ctu::sim::paper {
namespace {

using cull::NoRayBox;
using cull::RayBox;
using intersect::Hit;
using intersect::Ray;

constexpr std::size_t kPathsPerChunk = 256;
struct WideShape {
  int leaf_size;
  float triangle_cost;
};
constexpr WideShape kWideShapes[] = {{4, 1}, {4, 0.01f}, {8, 0.01f}, {15, 0.01f}};

/// A 4-wide tree with all that its traversals need to live.
struct WideTree {
  WideTree(const scene::Mesh& mesh, const WideShape& shape, int threads, const cull::MaskTester& no_masks)
      : bvh(accel::build(
            mesh, {.max_leaf_triangles = shape.leaf_size, .triangle_cost = shape.triangle_cost, .threads = threads})),
        boxes(reference::leaf_boxes(bvh)),
        plain(bvh, nullptr, no_masks),
        culled(bvh, nullptr, no_masks, &boxes) {}

  accel::Bvh4 bvh;
  std::vector<accel::PrimitiveBox> boxes;
  reference::Traversal plain, culled;
};

struct KdTrees {
  accel::KdTree plain, clipped;
};

struct Trees {
  std::vector<KdTrees> kd;
  std::vector<std::unique_ptr<WideTree>> wide;
};

accel::KdTree build(const scene::Mesh& mesh, int leaf_size, bool clip, double& seconds,
                    accel::KdStatistics& statistics) {
  const ThreadStopwatch watch;
  accel::KdTree tree = accel::build_kd_tree(mesh, {.max_leaf_primitives = leaf_size, .clip = clip});
  seconds = watch.seconds();
  statistics = accel::statistics(tree);
  return tree;
}

/// One chunk of rays through every tree.
class Chunk {
 public:
  Chunk(const Trees& trees, const HitJudge& judge) : trees_(trees), judge_(judge) {
    result_.kd.resize(trees.kd.size());
    result_.wide.resize(trees.wide.size());
  }

  void run(const RayboxRays& source, std::uint64_t first, std::uint64_t last) {
    source.generate(first, last, rays_);
    result_.rays = rays_.size();
    for (const Ray& ray : rays_) result_.shadow_rays += ray.kind == intersect::RayKind::AnyHit;
    for (std::size_t i = 0; i < trees_.kd.size(); ++i) {
      KdResult& row = result_.kd[i];
      const std::vector<Hit> plain = trace<NoRayBox>(trees_.kd[i].plain, row.plain, &row.plain_seconds);
      judge(plain, trace<RayBox>(trees_.kd[i].plain, row.culled, &row.culled_seconds));
      judge(plain, trace<NoRayBox>(trees_.kd[i].clipped, row.clipped, nullptr));
      judge(plain, trace<RayBox>(trees_.kd[i].clipped, row.clipped_culled, nullptr));
    }
    for (std::size_t i = 0; i < trees_.wide.size(); ++i) walk_wide(*trees_.wide[i], result_.wide[i]);
  }

  const RayboxResult& result() const { return result_; }

 private:
  template <class Box>
  std::vector<Hit> trace(const accel::KdTree& tree, reference::KdCounts& counts, double* seconds) const {
    std::vector<Hit> hits;
    hits.reserve(rays_.size());
    const ThreadStopwatch watch;
    for (const Ray& ray : rays_) hits.push_back(reference::trace_kd<Box>(tree, ray, counts));
    if (seconds != nullptr) *seconds += watch.seconds();
    return hits;
  }

  void walk_wide(const WideTree& tree, WideResult& row) {
    reference::StepList steps;
    std::vector<Hit> plain, culled;
    for (const Ray& ray : rays_) {
      plain.push_back(tree.plain.trace(ray, &steps));
      culled.push_back(tree.culled.trace(ray, nullptr, nullptr, &row.culled));
    }
    const reference::Counts counts = reference::count_steps(steps, 0, steps.rays());
    row.node_visits += counts.node_visits;
    row.leaf_visits += counts.leaf_visits;
    row.plain_tests += counts.triangle_tests;
    judge(plain, culled);
  }

  void judge(const std::vector<Hit>& without, const std::vector<Hit>& with) {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (same_bits(without[i], with[i])) continue;
      const Verdict verdict = judge_.judge(rays_[i], without[i], with[i]);
      ChangedHits& changed = result_.changed;
      ++(verdict == Verdict::Lost ? changed.lost : verdict == Verdict::NearMiss ? changed.near_misses : changed.ties);
    }
  }

  const Trees& trees_;
  const HitJudge& judge_;
  std::vector<Ray> rays_;
  RayboxResult result_;
};

void add(const RayboxResult& part, RayboxResult& sum) {
  sum.rays += part.rays;
  sum.shadow_rays += part.shadow_rays;
  sum.changed.lost += part.changed.lost;
  sum.changed.near_misses += part.changed.near_misses;
  sum.changed.ties += part.changed.ties;
  for (std::size_t i = 0; i < sum.kd.size(); ++i) {
    KdResult& to = sum.kd[i];
    const KdResult& from = part.kd[i];
    to.plain += from.plain;
    to.culled += from.culled;
    to.clipped += from.clipped;
    to.clipped_culled += from.clipped_culled;
    to.plain_seconds += from.plain_seconds;
    to.culled_seconds += from.culled_seconds;
  }
  for (std::size_t i = 0; i < sum.wide.size(); ++i) {
    sum.wide[i].node_visits += part.wide[i].node_visits;
    sum.wide[i].leaf_visits += part.wide[i].leaf_visits;
    sum.wide[i].plain_tests += part.wide[i].plain_tests;
    sum.wide[i].culled += part.wide[i].culled;
  }
}

}  // namespace

RayboxResult measure_raybox(const scene::Scene& scene, const RayboxSetting& setting, int threads,
                            const std::function<void(std::uint64_t)>& progress) {
  RayboxResult result;
  result.name = scene.name;
  result.triangles = scene.mesh.triangles.size();
  result.spheres = scene.mesh.spheres.size();
  result.max_depth = accel::default_kd_depth(scene.mesh.primitives());
  Trees trees;
  for (const int leaf_size : kLeafSizes) {
    KdResult& row = result.kd.emplace_back();
    row.leaf_size = leaf_size;
    KdTrees& built = trees.kd.emplace_back();
    built.plain = build(scene.mesh, leaf_size, false, row.build_seconds, row.tree);
    built.clipped = build(scene.mesh, leaf_size, true, row.clipped_build_seconds, row.clipped_tree);
  }
  const cull::MaskTester no_masks(cull::Design::None, {});
  for (const WideShape& shape : kWideShapes) {
    trees.wide.push_back(std::make_unique<WideTree>(scene.mesh, shape, threads, no_masks));
    WideResult& row = result.wide.emplace_back();
    row.leaf_size = shape.leaf_size;
    row.triangle_cost = shape.triangle_cost;
  }

  const RayboxRays source(scene, setting, trees.wide.front()->plain);
  const HitJudge judge(scene.mesh);
  std::mutex mutex;
  std::uint64_t paths_done = 0;
  parallel_chunks(source.paths(), kPathsPerChunk, threads, [&](std::size_t first, std::size_t last) {
    Chunk chunk(trees, judge);
    chunk.run(source, first, last);
    const std::lock_guard lock(mutex);
    add(chunk.result(), result);
    paths_done += last - first;
    progress(paths_done);
  });
  return result;
}

}  // namespace ctu::sim::paper
