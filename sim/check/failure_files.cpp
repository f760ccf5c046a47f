#include "sim/check/failure_files.h"

#include <fmt/format.h>

#include "sim/check/judge.h"
#include "traces/trace_writer.h"

namespace ctu::sim::check {
namespace {

traces::Manifest manifest_of(const CheckScene& scene, std::uint64_t seed) {
  traces::Manifest manifest;
  manifest.scene.name =
      fmt::format("check:{}?seed={}&scene={}", generators()[scene.number.generator].name, seed, scene.number.scene);
  manifest.scene.hash = scene::content_hash(scene.hard.mesh).hex();
  manifest.scene.triangles = scene.hard.mesh.triangles.size();
  manifest.scene.report.format = "generated";
  manifest.rays.kind = traces::RayOptions::Rays::Random;
  manifest.rays.seed = seed;
  manifest.rays.count = 1;
  manifest.build.max_leaf_triangles = scene.setup.leaf_triangles;
  manifest.masks = scene.setup.masks;
  return manifest;
}

}  // namespace

void write_one_ray_trace(const CheckScene& scene, std::uint32_t ray, std::uint64_t seed, const std::string& path) {
  const accel::Image image = image_of(scene);
  traces::TraceWriter writer(path, manifest_of(scene, seed), image, scene.masks.lut.get());
  reference::RayBlock block;
  block.rays = {scene.hard.rays[ray]};
  block.expected = {Judge(scene).true_hit(scene.hard.rays[ray])};
  writer.add(block, {});
  writer.finish({}, {});
}

std::string replay_command(const CullingSetup& setup, const std::string& engine, const std::string& path) {
  return fmt::format("ctusim run {} --engine {}{} --set mask_test.design={}", path, engine,
                     engine == "cycle" ? " --source exec" : "", cull::to_string(setup.design));
}

std::string name_of(const Failure& failure) {
  return fmt::format("{}-{}-{}", generators()[failure.number.generator].name, failure.number.scene, failure.ray);
}

}  // namespace ctu::sim::check
