#include "tests/fuzz/scene_inputs.h"

#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

#include "model/accel/build.h"
#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/fuzz/input_folder.h"
#include "traces/mask_set.h"
#include "traces/ray_generator.h"

namespace ctu::fuzz {
namespace {

constexpr std::size_t kMostBuilt = 400;  // triangles

constexpr const char* kPartPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr const char* kPartPbrt =
    "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n";
constexpr const char* kView = "LookAt 1 2 3 0 0 0 0 0 1\nCamera \"perspective\" \"float fov\" [40]\nWorldBegin\n";

/// What scenes may name: part.ply, part.obj, part.pbrt, view.pbrt, circle.pbrt, part.bin, and gone.ply as missing.
struct SceneFolder : InputFolder {
  SceneFolder() {
    put("part.ply", std::string_view(kPartPly));
    put("part.obj", std::string_view("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    put("part.pbrt", std::string_view(kPartPbrt));
    put("view.pbrt", std::string_view(kView));
    put("circle.pbrt", std::string_view("Include \"scene.pbrt\"\n"));
    put("MISSING.txt", std::string_view("gone.ply\n"));
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    char bytes[sizeof corners];
    std::memcpy(bytes, corners, sizeof corners);
    put("part.bin", std::string_view(bytes, sizeof bytes));
  }
};

const InputFolder& folder() {
  static const SceneFolder files;
  return files;
}

void check_mesh(const scene::Scene& scene) {
  require(scene.mesh.primitives() > 0, "a scene has triangles or spheres");
  for (const auto& triangle : scene.mesh.triangles)
    for (const std::uint32_t corner : triangle)
      require(corner < scene.mesh.vertices.size(), "a triangle's corners are vertices of the mesh");
  for (const Vec3& v : scene.mesh.vertices)
    require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "vertices are finite");
  for (const scene::Sphere& s : scene.mesh.spheres)
    require(std::isfinite(s.centre.x) && std::isfinite(s.centre.y) && std::isfinite(s.centre.z) &&
                std::isfinite(s.radius) && s.radius >= 0,
            "spheres are finite");
}

/// Every hit must be of a primitive that is there, within the ray.
void check_hits(const std::vector<intersect::Ray>& rays, const std::vector<intersect::Hit>& hits,
                const scene::Mesh& mesh) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].primitive == intersect::kNoPrimitive) continue;
    require(hits[i].primitive < mesh.primitives(), "a hit names a primitive of the scene");
    require(hits[i].t >= rays[i].tmin && hits[i].t <= rays[i].tmax, "a hit lies within its ray");
  }
}

/// What `record` and `culling` do with a scene, on one thread and a few rays; images hold triangles alone.
void use(const scene::Scene& scene) {
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  const cull::MaskOptions options;
  const traces::MaskSet set = traces::make_masks(bvh, options, 1);
  if (scene.mesh.spheres.empty()) {
    accel::validate(traces::image_of(bvh, &set, {}));
    accel::validate(traces::image_of(bvh, nullptr, {}));
  }
  const cull::MaskTester tester(cull::Design::Comparators, options);
  const reference::Traversal traversal(bvh, &set.masks, tester);
  for (const auto kind : {traces::RayOptions::Rays::Diffuse, traces::RayOptions::Rays::Shadow,
                          traces::RayOptions::Rays::Ao, traces::RayOptions::Rays::Random}) {
    traces::RayOptions ray_options;
    ray_options.kind = kind;
    ray_options.width = ray_options.height = 3;
    const traces::RayGenerator generator(scene, ray_options);
    std::vector<intersect::Ray> rays;
    std::vector<intersect::Hit> hits;
    generator.generate(
        0, generator.paths(), [&](const intersect::Ray& ray, bool) { return traversal.trace(ray, nullptr); }, rays,
        hits);
    check_hits(rays, hits, scene.mesh);
  }
}

void load_and_use(const std::string& name) {
  accepts([&] {
    const scene::Scene scene = scene::load(name);
    check_mesh(scene);
    if (scene.mesh.primitives() <= kMostBuilt) use(scene);
  });
}

}  // namespace

void load_scene(const char* extension, Input input) {
  load_and_use(folder().put(std::string("scene.") + extension, input));
}

void load_generated(Input input) {
  constexpr std::size_t kRefused = 8;  // digits: numbers of so many are beyond every limit
  const std::size_t kept = as_text(input).starts_with("tetra") || as_text(input).starts_with("balls") ? 1 : 2;
  std::string name = "gen:";
  std::string digits;
  const auto flush = [&] {
    if (digits.size() > kept && digits.size() < kRefused) digits.resize(kept);
    name += digits;
    digits.clear();
  };
  for (const std::uint8_t byte : input) {
    if (std::isdigit(byte) != 0) {
      digits += static_cast<char>(byte);
      continue;
    }
    flush();
    name += static_cast<char>(byte);
  }
  flush();
  load_and_use(name);
}

}  // namespace ctu::fuzz
