#include "sim/check/generators.h"

namespace ctu::sim::check {

std::span<const Generator> generators() {
  static const std::vector<Generator> all = [] {
    std::vector<Generator> list;
    for (const auto family : {ray_direction_generators, ray_origin_generators, ray_interval_generators,
                              aimed_ray_generators, box_shape_generators, scale_generators, mesh_generators})
      list.insert(list.end(), family().begin(), family().end());
    return list;
  }();
  return all;
}

HardCase make_case(std::uint64_t seed, std::uint32_t generator, std::uint64_t scene) {
  CaseRandom random(seed, generator, scene);
  HardCase out;
  generators()[generator].make(random, out);
  return out;
}

}  // namespace ctu::sim::check
