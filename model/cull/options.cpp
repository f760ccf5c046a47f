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
                           {Design::BitTable, "bit-table"},
                           {Design::Dedup, "dedup"},
                           {Design::Projection, "projection"},
                           {Design::Comparators, "comparators"}};

struct SelectionName {
  Selection selection;
  std::string_view text;
};

constexpr SelectionName kSelectionNames[] = {
    {Selection::TopPerNode, "top-per-node"}, {Selection::TopSummed, "top-summed"}, {Selection::Refined, "refined"}};

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

std::string_view to_string(Selection selection) {
  for (const SelectionName& name : kSelectionNames)
    if (name.selection == selection) return name.text;
  return "unknown";
}

std::optional<Selection> selection_from_string(std::string_view text) {
  for (const SelectionName& name : kSelectionNames)
    if (name.text == text) return name.selection;
  return std::nullopt;
}

void validate(const MaskOptions& options) {
  validate_object_masks(options);
  require_range("ray resolution R_ray", options.ray_resolution, options.resolution, kMaxRayResolution);
}

void validate_object_masks(const MaskOptions& options) {
  require_range("mask resolution R", options.resolution, kMinResolution, kMaxResolution);
  require_range("mask levels L", options.levels, kUnlimitedLevels, kMaxLevels);
  if (options.entries != 0) require_range("entries of the compression LUT", options.entries, kMinEntries, kMaxEntries);
}

}  // namespace ctu::cull
