#include "sim/metamorph/scene_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sim/metamorph/aimed_rays.h"
#include "sim/metamorph/answers.h"
#include "sim/metamorph/carried.h"
#include "sim/metamorph/closed_parts.h"
#include "sim/metamorph/scene_rays.h"

namespace ctu::sim::metamorph {
namespace {

using cull::Design;
using intersect::Hit;
using intersect::Ray;

constexpr double kCollapsing = 1e6;  // sizes of the scene
constexpr std::size_t kMostVisits = 50'000'000, kLeastRays = 16;

/// All checks of one scene. The scene as it is stays at hand: its rays and answers are what the others are held
/// against.
class SceneCheck {
 public:
  SceneCheck(const scene::Scene& scene, const CheckOptions& options)
      : scene_(scene),
        options_(options),
        threads_(options.world.threads),
        world_(accel::build(scene.mesh, options.world.build), options.world),
        asked_(ask_all(world_, scene_rays(scene, world_.bvh(), options.rays), threads_, Record::HitsAndSteps)),
        magnitudes_(magnitudes(scene.mesh, asked_.rays)) {
    report_.triangles = scene.mesh.triangles.size();
  }

  SceneReport run(const std::function<void(const std::string&)>& progress) {
    const TransformationList list = transformations(options_.kinds, magnitudes_);
    report_.left_out = list.left_out;
    for (const Transformation& t : list.transformations) {
      progress(t.name);
      report_.rows.push_back(t.kind == Kind::Identity ? as_it_is(t) : transformed(t));
    }
    if (options_.reversed) progress("rays reversed"), report_.rows.push_back(backwards());
    if (options_.edges) progress("edges"), check_edges();
    return std::move(report_);
  }

 private:
  CheckRow as_it_is(const Transformation& t) {
    CheckRow row{.name = t.name, .kind = t.kind, .rays = asked_.rays.size()};
    row.changed = judge_hits(scene_.mesh, world_, asked_, tell_of(row));
    return row;
  }

  CheckRow transformed(const Transformation& t) {
    CheckRow row{.name = t.name, .kind = t.kind};
    const scene::Mesh mesh = t(scene_.mesh);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < asked_.rays.size(); i += ray_stride(t)) rays.push_back(t(asked_.rays[i]));
    row.rays = rays.size();
    const World world(accel::build(mesh, options_.world.build), options_.world);
    const Asked asked =
        ask_all(world, std::move(rays), threads_, t.kind == Kind::Power ? Record::HitsAndSteps : Record::Hits);
    row.changed = judge_hits(mesh, world, asked, tell_of(row));
    if (!t.is_exact()) return row;

    const std::vector<bool> compared = compared_rays(t, row);
    row.same = Same::Yes;
    expect(different_hits(asked_.best, asked.best, t, compared) == 0, "the best of all triangles differs", row);
    if (t.kind == Kind::Power)
      compare_rebuilt(t, world, asked, compared, row);
    else
      compare_carried(t, asked.rays, compared, row);
    return row;
  }

  /// Moved so far that a unit in the last place is a sizeable part of the scene, the scene falls onto a few points, and
  /// a ray there meets a good part of all triangles: then only every nth ray is asked.
  std::size_t ray_stride(const Transformation& t) const {
    if (t.kind != Kind::Translation || std::fabs(t.offset.x) < kCollapsing * magnitudes_.size) return 1;
    const std::size_t most = std::max(kLeastRays, kMostVisits / scene_.mesh.triangles.size());
    return std::max<std::size_t>(1, asked_.rays.size() / most);
  }

  std::vector<bool> compared_rays(const Transformation& t, CheckRow& row) const {
    std::vector<bool> compared;
    compared.reserve(asked_.rays.size());
    for (const Ray& ray : asked_.rays) compared.push_back(keeps_bits(t, ray, magnitudes_));
    row.not_compared = static_cast<std::uint64_t>(std::count(compared.begin(), compared.end(), false));
    return compared;
  }

  /// A scale by a power of two: the builder must come to the same tree, and so must everything behind it.
  void compare_rebuilt(const Transformation& t, const World& world, const Asked& asked,
                       const std::vector<bool>& compared, CheckRow& row) {
    expect(same_tree(carried(world_.bvh(), t), world.bvh()), "the tree differs", row);
    expect(world_.masks().bits == world.masks().bits, "object masks differ", row);
    expect(world_.compressed_masks().bits == world.compressed_masks().bits &&
               world_.compressed_masks().index == world.compressed_masks().index,
           "compressed masks differ", row);
    for (std::size_t d = 0; d < world.designs(); ++d)
      compare(t, world.design(d), asked_.answers[d], asked.answers[d], Keys::Compared, compared, row);
  }

  /// Axes that change places or sides: the same tree and masks, carried along.
  void compare_carried(const Transformation& t, const std::vector<Ray>& rays, const std::vector<bool>& compared,
                       CheckRow& row) {
    const World world(carried(world_.bvh(), t), carried(world_.masks(), t), options_.world);
    for (std::size_t d = 0; d < world.designs(); ++d) {
      const Design design = world.design(d);
      // A point on a border lies in the cell above it; mirrored, that is the other one.
      if (t.kind == Kind::Mirror && cull::reads_tables(design)) continue;
      compare(t, design, answers_of(design), ask(world.traversal(d), rays, threads_, Record::HitsAndSteps),
              Keys::Ignored, compared, row);
    }
  }

  const Answers& answers_of(Design design) const {
    std::size_t d = 0;
    while (world_.design(d) != design) ++d;
    return asked_.answers[d];
  }

  void compare(const Transformation& t, Design design, const Answers& a, const Answers& b, Keys keys,
               const std::vector<bool>& compared, CheckRow& row) {
    const std::uint64_t hits = different_hits(a.hits, b.hits, t, compared);
    const std::uint64_t steps = different_steps(a, b, keys, compared);
    expect(hits == 0, fmt::format("{}: {} hits differ", to_string(design), hits), row);
    expect(steps == 0, fmt::format("{}: {} event sequences differ", to_string(design), steps), row);
  }

  /// For hits found, the ray from behind the hit back over the same line.
  CheckRow backwards() {
    CheckRow row{.name = "rays reversed"};
    std::vector<Ray> rays;
    std::vector<std::uint32_t> from;
    for (std::size_t i = 0; i < asked_.rays.size(); ++i) {
      const Hit& hit = asked_.answers[0].hits[i];
      if (hit.primitive == intersect::kNoPrimitive) continue;
      const Ray back = reversed(asked_.rays[i], hit.t);
      if (!intersect::is_valid(back)) continue;
      rays.push_back(back);
      from.push_back(hit.primitive);
    }
    row.rays = rays.size();
    const Asked asked = ask_all(world_, std::move(rays), threads_, Record::Hits);
    row.changed = judge_hits(scene_.mesh, world_, asked, tell_of(row));
    const WayBack way = judge_way_back(scene_.mesh, world_, asked, from, tell_of(row));
    row.changed.lost += way.lost;
    row.declined = way.declined;
    return row;
  }

  void check_edges() {
    const ClosedParts closed = closed_parts(scene_.mesh);
    report_.edges_checked = true;
    EdgeRow& row = report_.edges;
    row.parts = closed.parts;
    row.triangles = closed.triangles.size();
    if (closed.triangles.empty()) return;
    const AimedRays aimed = aim_at_edges(scene_.mesh, closed, options_.seed, options_.most_aimed);
    row.edges = aimed.edges, row.vertices = aimed.vertices, row.folds = aimed.folds;
    row.rays = aimed.rays.size();
    row.found = find_leaks(scene_.mesh, world_, aimed.rays, threads_,
                           [this](const std::string& words) { defect("edges: " + words); });
  }

  TellDefect tell_of(const CheckRow& row) {
    return [this, name = row.name](const std::string& words) { defect(name + ": " + words); };
  }

  void expect(bool same, const std::string& what, CheckRow& row) {
    if (same) return;
    row.same = Same::No;
    defect(fmt::format("{}: NOT THE SAME: {}", row.name, what));
  }

  void defect(const std::string& words) {
    if (report_.defects.size() < kMostDefects) report_.defects.push_back(words);
  }

  const scene::Scene& scene_;
  const CheckOptions& options_;
  const int threads_;
  const World world_;
  const Asked asked_;
  const Magnitudes magnitudes_;
  SceneReport report_;
};

}  // namespace

bool SceneReport::passed() const {
  return edges.found.leaks == 0 && std::all_of(rows.begin(), rows.end(), [](const CheckRow& row) {
           return row.changed.lost == 0 && row.same != Same::No;
         });
}

SceneReport check_scene(const scene::Scene& scene, const CheckOptions& options,
                        const std::function<void(const std::string&)>& progress) {
  return SceneCheck(scene, options).run(progress);
}

}  // namespace ctu::sim::metamorph
