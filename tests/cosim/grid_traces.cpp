#include "tests/cosim/grid_traces.h"

#include <algorithm>
#include <limits>
#include <random>

#include "model/accel/build.h"
#include "model/accel/forest.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "tests/cosim/grid_configs.h"
#include "tests/oracle/seed.h"
#include "tests/support/aimed_rays.h"

namespace ctu::cosim {
namespace {

using intersect::Ray;
using intersect::RayKind;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Rays about a mesh.
class RaySource {
 public:
  RaySource(const accel::Bvh4& tree, const scene::Mesh& mesh)
      : mesh_(mesh), lower_(tree.lower), upper_(tree.upper), random_(oracle::test_seed()) {}

  /// The middle of some triangle.
  Vec3 surface_point() {
    const auto& triangle = mesh_.triangles[random_() % mesh_.triangles.size()];
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] =
          (mesh_.vertices[triangle[0]][axis] + mesh_.vertices[triangle[1]][axis] + mesh_.vertices[triangle[2]][axis]) /
          3;
    return p;
  }

  /// Within the box about its middle that is `factor` times as large.
  Vec3 point(float factor) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const float middle = (lower_[axis] + upper_[axis]) / 2, half = (upper_[axis] - lower_[axis]) / 2;
      p[axis] = middle + factor * half * (2 * uniform() - 1);
    }
    return p;
  }
  Ray between(const Vec3& from, const Vec3& to, float tmax, RayKind kind) {
    Ray ray;
    ray.origin = from;
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = to[axis] - from[axis];
    ray.tmax = tmax;
    ray.kind = kind;
    return ray;
  }
  float uniform() { return static_cast<float>(random_() >> 40) * 0x1p-24f; }
  std::mt19937_64& random() { return random_; }

 private:
  const scene::Mesh& mesh_;
  Vec3 lower_, upper_;
  std::mt19937_64 random_;
};

/// Rays along axes, within planes, of no direction, with no room between tmin and tmax, and of no numbers.
Ray hostile_ray(RaySource& source, int i) {
  Ray ray = source.between(source.point(i % 3 == 0 ? 1.0f : 1e4f), source.point(1.0f), kInfinity,
                           i % 5 == 0 ? RayKind::AnyHit : RayKind::ClosestHit);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const int axis = static_cast<int>(source.random()() % 3);
  switch (i % 12) {
    case 0:
      ray.direction[axis] = 0;
      break;
    case 1:
      ray.direction[axis] = -0.0f;
      ray.direction[(axis + 1) % 3] = 0;
      break;
    case 2:
      ray.direction[axis] *= 1e-30f;
      break;
    case 3:
      ray.direction[axis] = std::numeric_limits<float>::denorm_min();
      break;
    case 4:
      ray.tmin = ray.tmax = 0.5f;
      break;
    case 5:
      ray.tmin = -1;
      ray.tmax = 1;
      break;
    case 6:
      for (int a = 0; a < 3; ++a) ray.direction[a] *= 1e-38f;
      break;
    case 7:
      for (int a = 0; a < 3; ++a) ray.direction[a] *= 1e34f;
      break;
    case 8:
      ray.direction = {};
      break;
    case 9:
      ray.origin[axis] = kNan;
      break;
    case 10:
      ray.tmin = 2;
      ray.tmax = 1;
      break;
    default:
      ray.tmax = 1;
      break;
  }
  return ray;
}

std::vector<Ray> rays_of(const std::string& trace, RaySource& source, int count) {
  std::vector<Ray> rays;
  const Vec3 light = source.point(2.5f);
  for (int i = 0; i < count; ++i) {
    const RayKind mixed = i % 4 == 3 ? RayKind::AnyHit : RayKind::ClosestHit;
    const Vec3 target = source.surface_point();
    if (trace == "hair")
      rays.push_back(source.between(source.point(1.5f), target, kInfinity, mixed));
    else if (trace == "interior")
      rays.push_back(source.between(source.point(0.9f), target, i % 3 == 0 ? 1.0f : kInfinity, mixed));
    else if (trace == "shadow")
      rays.push_back(source.between(target, light, 1, RayKind::AnyHit));
    else if (trace == "any-hit")
      rays.push_back(source.between(source.point(1.5f), target, kInfinity, RayKind::AnyHit));
    else
      rays.push_back(hostile_ray(source, i));
  }
  return rays;
}

/// The mesh with the build's kinds of primitives, in leaves as large as it keeps where it culls within them.
accel::Bvh4 tree_for(const RtlParameters& build, scene::Mesh& mesh) {
  if (build.spheres) test::add_spheres(mesh);
  if (!build.primitive_boxes) return accel::build(mesh, {});
  const auto bytes = static_cast<int>(accel::primitive_bytes({.primitive_boxes = true}));
  return accel::build(mesh, {.max_leaf_triangles = std::min(build.max_leaf_bytes / bytes, accel::kMaxLeafTriangles),
                             .triangle_cost = 0.01f});
}

/// In four of five packets the valid rays begin where their first one does, or near it, and go nearly its way, each to
/// its own end.
void gather(std::vector<Ray>& rays, int size) {
  const auto valid = [](const Ray& ray) { return intersect::prepare_ray(ray).valid; };
  const Ray* first = nullptr;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t place = i % static_cast<std::size_t>(size), packet = i / static_cast<std::size_t>(size);
    if (place == 0) first = nullptr;
    if (packet % 5 == 4 || !valid(rays[i])) continue;
    if (first == nullptr) {
      first = &rays[i];
      continue;
    }
    Ray gathered = rays[i];
    for (int axis = 0; axis < 3; ++axis) {
      const float away = i % 2 == 0 ? 0.0f : 0.01f;
      gathered.origin[axis] = first->origin[axis] + away * (rays[i].origin[axis] - first->origin[axis]);
      gathered.direction[axis] = first->direction[axis] + 0.02f * rays[i].direction[axis];
    }
    if (valid(gathered)) rays[i] = gathered;
  }
}

/// How the rays go about it.
struct Ways {
  reference::PacketPlan packets;
  int trees;
};

/// Runs of rays that walk the same tree, which packets need, and some that change it from ray to ray.
std::vector<std::uint8_t> drawn_trees(int trees, int packet_size) {
  std::mt19937_64 random(oracle::test_seed() + 1);
  std::vector<std::uint8_t> drawn;
  while (drawn.size() < 97) {
    const std::uint64_t run = random() % 4 == 0 ? 1 : 1 + random() % static_cast<std::uint64_t>(packet_size);
    drawn.insert(drawn.end(), run, static_cast<std::uint8_t>(random() % static_cast<unsigned>(trees)));
  }
  return drawn;
}

/// Puts trees over the same mesh, of leaves of other sizes, behind the first one.
void add_trees(accel::Bvh4& first, const scene::Mesh& mesh, int trees) {
  for (int i = 1; i < trees; ++i)
    accel::append_tree(first,
                       accel::build(mesh, {.max_leaf_triangles = 1 + i % 4, .triangle_cost = 0.5f * (1 + i % 3)}));
}

std::unique_ptr<test::World> make_world(const RtlParameters& build, accel::Bvh4 tree, const scene::Mesh& mesh,
                                        std::vector<Ray> rays, const Ways& ways) {
  if (ways.packets.any()) gather(rays, ways.packets.size);
  add_trees(tree, mesh, ways.trees);
  auto world = std::make_unique<test::World>(std::move(tree), build.design, rays, mask_options(build), build.box_bits,
                                             build.primitive_boxes);
  if (ways.trees > 1) world->walk_trees(drawn_trees(ways.trees, ways.packets.any() ? 2 * ways.packets.size : 4));
  if (ways.packets.any()) world->travel_in(ways.packets);
  return world;
}

std::unique_ptr<test::World> make_hostile(const RtlParameters& build, int count, const Ways& ways) {
  test::ClosedMesh cube = test::closed_cube(4);
  accel::Bvh4 tree = tree_for(build, cube.mesh);
  RaySource source(tree, cube.mesh);
  test::AimedRays aimed(cube, oracle::test_seed());
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i)
    rays.push_back(i % 2 == 0
                       ? hostile_ray(source, i / 2)
                       : aimed.next(test::kFamilies[static_cast<std::size_t>(i / 2) % std::size(test::kFamilies)]));
  return make_world(build, std::move(tree), cube.mesh, std::move(rays), ways);
}

}  // namespace

std::unique_ptr<test::World> make_grid_world(const std::string& trace, const RtlParameters& build, int rays,
                                             const reference::PacketPlan& packets, int trees) {
  const Ways ways{packets, trees};
  if (trace == "hostile") return make_hostile(build, rays, ways);
  const char* const scene = trace == "interior" ? "gen:foliage?twigs=40" : "gen:hair-ball?strands=200";
  scene::Mesh mesh = scene::load(scene).mesh;
  accel::Bvh4 tree = tree_for(build, mesh);
  RaySource source(tree, mesh);
  std::vector<Ray> list = rays_of(trace == "single" ? "hair" : trace, source, trace == "single" ? 1 : rays);
  return make_world(build, std::move(tree), mesh, std::move(list), ways);
}

}  // namespace ctu::cosim
