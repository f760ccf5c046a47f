// `ctusim trace areas`: the influence areas of the lights that a recorded trace's rays run to, found from the rays
// alone, and what local trees for them would save.
#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/influence/find_areas.h"
#include "model/reference/selecting_traversal.h"
#include "sim/commands.h"
#include "sim/hit_judge.h"
#include "sim/loaded_trace.h"

namespace ctu::sim {
namespace {

/// The scene of a trace, from its tree: each triangle with vertices of its own. Throws Error unless every triangle of
/// the scene is there once.
scene::Mesh mesh_of(const LoadedTrace& trace, const std::string& path) {
  const std::vector<accel::LeafTriangle>& triangles = trace.bvh().triangles;
  const auto refuse = [&](const std::string& what) { throw Error(path, what, "record the trace again"); };
  if (triangles.size() != trace.reader().manifest().scene.triangles)
    refuse(fmt::format("{} triangles of a scene of {}", triangles.size(), trace.reader().manifest().scene.triangles));
  scene::Mesh mesh;
  mesh.triangles.resize(triangles.size());
  mesh.vertices.reserve(3 * triangles.size());
  std::vector<bool> met(triangles.size());
  for (const accel::LeafTriangle& triangle : triangles) {
    if (triangle.primitive >= triangles.size() || met[triangle.primitive])
      refuse(fmt::format("primitive {} is not there once", triangle.primitive));
    met[triangle.primitive] = true;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles[triangle.primitive] = {first, first + 1, first + 2};
    for (const Vec3& v : {triangle.v0, triangle.v1, triangle.v2}) mesh.vertices.push_back(v);
  }
  return mesh;
}

struct RecordedRays {
  std::vector<intersect::Ray> rays;
  std::vector<intersect::Hit> hits;
};

RecordedRays rays_of(const LoadedTrace& trace) {
  RecordedRays recorded;
  traces::TraceFeed feed(trace.reader(), {});
  while (const auto block = feed.next()) {
    recorded.rays.insert(recorded.rays.end(), block->rays.begin(), block->rays.end());
    recorded.hits.insert(recorded.hits.end(), block->expected.begin(), block->expected.end());
  }
  return recorded;
}

void print_areas(const influence::FoundAreas& found, const influence::TreeSet& trees) {
  fmt::print("{} of {} rays looked at run to a light: {} areas, {} of them with triangles\n",
             found.looked_at - found.unclaimed, found.looked_at, found.areas.size(), trees.areas().size());
  for (std::size_t i = 0; i < trees.areas().size(); ++i) {
    const influence::InfluenceArea& area = trees.areas()[i].area();
    const Vec3& shown = area.kind == influence::AreaKind::Point ? area.origin : area.axes[2];
    fmt::print("  {} {} {:.6g} {:.6g} {:.6g}: cross-section {:.3g} x {:.3g}, from {:.4g} to {:.4g}; {} triangles\n",
               to_string(area.kind), area.kind == influence::AreaKind::Point ? "near" : "along", shown.x, shown.y,
               shown.z, 2 * area.half_x, 2 * area.half_y, area.near, area.far, trees.local(i).triangles.size());
  }
}

/// Any hit answers an any-hit ray.
bool same_answer(const intersect::Ray& ray, const intersect::Hit& a, const intersect::Hit& b) {
  if (ray.kind == intersect::RayKind::ClosestHit) return same_bits(a, b);
  return (a.primitive == intersect::kNoPrimitive) == (b.primitive == intersect::kNoPrimitive);
}

}  // namespace

int trace_areas_command(const TraceArgs& args) {
  const LoadedTrace trace(args.trace);
  const RecordedRays recorded = rays_of(trace);
  const accel::Bvh4& bvh = trace.bvh();
  const influence::FoundAreas found = influence::find_areas(recorded.rays, bvh.lower, bvh.upper);
  influence::TreeSetOptions options;
  options.build = trace.reader().manifest().build;
  const scene::Mesh mesh = mesh_of(trace, args.trace);
  const influence::TreeSet trees(mesh, bvh, found.list(), options);
  print_areas(found, trees);

  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal global(bvh, nullptr, no_culling);
  const reference::SelectingTraversal selecting(trees);
  reference::SelectionRecord record;
  reference::StepList alone;
  const HitJudge judge(mesh);
  std::uint64_t changed = 0, lost = 0;
  for (std::size_t i = 0; i < recorded.rays.size(); ++i) {
    const intersect::Ray& ray = recorded.rays[i];
    global.trace(ray, &alone);
    const intersect::Hit hit = selecting.trace(ray, &record);
    if (same_answer(ray, hit, recorded.hits[i])) continue;
    ++changed;
    lost += judge.judge(ray, recorded.hits[i], hit) == Verdict::Lost ? 1 : 0;
  }
  const std::uint64_t work = record.local_counts().intersections() + record.global_counts().intersections();
  const double rays = static_cast<double>(std::max<std::uint64_t>(record.rays, 1));
  fmt::print("{} rays: {} affine, {} with their answer in a local tree\n", record.rays, record.affine, record.final);
  fmt::print("tests/ray: {:.2f} in the global tree alone, {:.2f} with local trees first; {:.2f} times its memory\n",
             reference::count_steps(alone, 0, alone.rays()).intersections_per_ray(), double(work) / rays,
             trees.memory_ratio());
  fmt::print("answers that differ from the recorded ones: {}; lost hits: {}\n", changed, lost);
  return lost == 0 ? 0 : 1;
}

}  // namespace ctu::sim
