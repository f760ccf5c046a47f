#include "model/cull/options.h"

#include <string>

#include "model/base/error.h"

namespace ctu::cull {
namespace {

struct Name {
  Design design;
  std::string_view text;
};

constexpr Name kNames[] = {{Design::None, "none"},
                           {Design::Ideal, "ideal"},
                           {Design::MaskLut, "mask-lut"},
                           {Design::Projection, "projection"},
                           {Design::Comparators, "comparators"}};

void require_range(std::string_view name, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw Error(std::string(name), "is " + std::to_string(value),
              "choose a value from " + std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

std::string_view to_string(Design design) {
  for (const Name& name : kNames)
    if (name.design == design) return name.text;
  return "unknown";
}

std::optional<Design> design_from_string(std::string_view text) {
  for (const Name& name : kNames)
    if (name.text == text) return name.design;
  return std::nullopt;
}

void validate(const MaskOptions& options) {
  require_range("mask resolution R", options.resolution, kMinResolution, kMaxResolution);
  require_range("ray resolution R_ray", options.ray_resolution, kMinResolution, kMaxRayResolution);
  require_range("mask levels L", options.levels, kUnlimitedLevels, kMaxLevels);
}

}  // namespace ctu::cull
