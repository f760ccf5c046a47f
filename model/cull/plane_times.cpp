#include "model/cull/plane_times.h"

#include <array>

namespace ctu::cull {
namespace {

LerpWeights make_weights(int resolution) {
  LerpWeights weights;
  const float r = static_cast<float>(resolution);
  for (int slot = 0; slot < 4 * kPlaneGroups; ++slot) {
    const float k = static_cast<float>(slot + 1 < resolution ? slot + 1 : resolution - 1);
    const int group = slot / 4, element = slot % 4;
    weights.first_down[group][element] = numeric::div<Round::Down>(r - k, r);
    weights.first_up[group][element] = numeric::div<Round::Up>(r - k, r);
    weights.second_down[group][element] = numeric::div<Round::Down>(k, r);
    weights.second_up[group][element] = numeric::div<Round::Up>(k, r);
  }
  return weights;
}

std::array<LerpWeights, kMaxRayResolution + 1> make_all_weights() {
  std::array<LerpWeights, kMaxRayResolution + 1> all{};
  for (int r = kMinResolution; r <= kMaxRayResolution; ++r) all[static_cast<std::size_t>(r)] = make_weights(r);
  return all;
}

}  // namespace

const LerpWeights& lerp_weights(int resolution) {
  static const auto all = make_all_weights();
  return all[static_cast<std::size_t>(resolution)];
}

}  // namespace ctu::cull
