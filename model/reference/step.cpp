#include "model/reference/step.h"

#include <bit>

namespace ctu::reference {

Counts& Counts::operator+=(const Counts& other) {
  rays += other.rays;
  node_visits += other.node_visits;
  triangle_tests += other.triangle_tests;
  boxed_out += other.boxed_out;
  leaf_visits += other.leaf_visits;
  box_hits += other.box_hits;
  culled += other.culled;
  uncertain += other.uncertain;
  dropped += other.dropped;
  return *this;
}

Counts count_steps(const StepList& list, std::uint64_t first_ray, std::uint64_t last_ray) {
  Counts counts;
  counts.rays = last_ray - first_ray;
  for (std::uint64_t ray = first_ray; ray < last_ray; ++ray) {
    counts.dropped += list.tail_dropped[ray];
    for (std::uint64_t i = list.first_step[ray]; i < list.first_step[ray + 1]; ++i) {
      const Step& step = list.steps[i];
      counts.dropped += step.dropped;
      if (step.is_leaf()) {
        ++counts.leaf_visits;
        counts.triangle_tests += static_cast<std::uint64_t>(step.triangles_tested());
        counts.boxed_out += static_cast<std::uint64_t>(accel::leaf_count(step.ref) - step.triangles_tested());
      } else {
        ++counts.node_visits;
        counts.box_hits += static_cast<std::uint64_t>(std::popcount(step.box_hits()));
        counts.culled += static_cast<std::uint64_t>(std::popcount(step.box_hits() & ~step.survivors()));
        counts.uncertain += static_cast<std::uint64_t>(std::popcount(step.uncertain()));
      }
    }
  }
  return counts;
}

}  // namespace ctu::reference
