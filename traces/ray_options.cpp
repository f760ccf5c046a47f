#include "traces/ray_options.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::traces {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"primary", "diffuse", "shadow", "ao", "random"};
constexpr std::uint32_t kMaxSide = 1u << 15, kMaxSamples = 1u << 20, kMaxBounces = 1023;

void in_range(const char* name, std::uint64_t value, std::uint64_t low, std::uint64_t high) {
  if (value < low || value > high)
    throw Error("rays", fmt::format("{} is {}", name, value), fmt::format("give {} to {}", low, high));
}

}  // namespace

std::string_view to_string(RayOptions::Rays kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::optional<RayOptions::Rays> rays_from_string(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<RayOptions::Rays>(i);
  return std::nullopt;
}

void check(const RayOptions& options) {
  in_range("width", options.width, 1, kMaxSide);
  in_range("height", options.height, 1, kMaxSide);
  in_range("samples_per_pixel", options.samples_per_pixel, 1, kMaxSamples);
  in_range("bounces", options.bounces, 0, kMaxBounces);
  in_range("count", options.count, 0, std::uint64_t{1} << 40);
  if (options.kind == RayOptions::Rays::Diffuse && options.skip_primary && options.bounces == 0)
    throw Error("rays", "no bounces and no primary rays leave nothing to record", "give bounces of 1 or more");
  if (!(options.ao_radius > 0) || !std::isfinite(options.ao_radius))
    throw Error("rays", fmt::format("ao_radius is {}", options.ao_radius), "give a positive fraction of the diagonal");
  if (options.light)
    for (int axis = 0; axis < 3; ++axis)
      if (!std::isfinite((*options.light)[axis])) throw Error("rays", "the light is not at a finite position", "");
}

}  // namespace ctu::traces
