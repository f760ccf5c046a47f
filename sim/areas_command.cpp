// `ctusim trace areas`: the influence areas of the lights that a recorded trace's rays run to, found from the rays
// alone, and what local trees for them would save.
#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/influence/find_areas.h"
#include "sim/commands.h"
#include "sim/loaded_trace.h"
#include "sim/selection_survey.h"

namespace ctu::sim {
namespace {

/// The scene of a trace, from the tree over all of it, which is the first: each triangle with vertices of its own.
/// Throws Error unless every primitive of the scene is there once.
scene::Mesh mesh_of(const LoadedTrace& trace, const std::string& path) {
  const traces::SceneInfo& scene = trace.reader().manifest().scene;
  const std::size_t primitives = scene.triangles + scene.spheres;
  const auto refuse = [&](const std::string& what) { throw Error(path, what, "record the trace again"); };
  if (trace.bvh().triangles.size() < primitives)
    refuse(fmt::format("{} primitives of a scene of {}", trace.bvh().triangles.size(), primitives));
  scene::Mesh mesh;
  mesh.triangles.resize(scene.triangles);
  mesh.spheres.resize(scene.spheres);
  mesh.vertices.reserve(3 * scene.triangles);
  std::vector<bool> met(primitives);
  for (std::size_t i = 0; i < primitives; ++i) {
    const accel::LeafTriangle& primitive = trace.bvh().triangles[i];
    const std::uint32_t id = primitive.id();
    if (id >= primitives || met[id] || primitive.is_sphere() != (id >= scene.triangles))
      refuse(fmt::format("primitive {} is not there once", id));
    met[id] = true;
    if (primitive.is_sphere()) {
      mesh.spheres[id - scene.triangles] = primitive.sphere();
      continue;
    }
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles[id] = {first, first + 1, first + 2};
    for (const Vec3& v : {primitive.v0, primitive.v1, primitive.v2}) mesh.vertices.push_back(v);
  }
  return mesh;
}

std::vector<intersect::Ray> rays_of(const LoadedTrace& trace) {
  std::vector<intersect::Ray> rays;
  traces::TraceFeed feed(trace.reader(), {});
  while (const auto block = feed.next()) rays.insert(rays.end(), block->rays.begin(), block->rays.end());
  return rays;
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

}  // namespace

int trace_areas_command(const TraceArgs& args) {
  const LoadedTrace trace(args.trace);
  const std::vector<intersect::Ray> rays = rays_of(trace);
  const scene::Mesh mesh = mesh_of(trace, args.trace);
  const accel::Bvh4 bvh = accel::build(mesh, trace.reader().manifest().build);
  const influence::FoundAreas found = influence::find_areas(rays, bvh.lower, bvh.upper);
  influence::TreeSetOptions options;
  options.build = trace.reader().manifest().build;
  const influence::TreeSet trees(mesh, bvh, found.list(), options);
  print_areas(found, trees);

  const SelectionSurvey survey = survey_selection(mesh, trees, rays);
  fmt::print("{} rays: {} affine, {} with their answer in a local tree\n", survey.record.rays, survey.record.affine,
             survey.record.final);
  fmt::print("tests/ray: {:.2f} in the global tree alone, {:.2f} with local trees first; {:.2f} times its memory\n",
             survey.alone.intersections_per_ray(), survey.selecting_cost(), trees.memory_ratio());
  fmt::print("answers that differ from those of the global tree: {}; lost hits: {}\n", survey.changed, survey.lost);
  return survey.lost == 0 ? 0 : 1;
}

}  // namespace ctu::sim
