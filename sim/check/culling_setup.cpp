#include "sim/check/culling_setup.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::sim::check {
namespace {

using cull::Design;

/// Tables larger than this are made for the smallest R_ray only: a campaign of seconds must not spend them on tables.
constexpr double kQuickTableBytes = 1 << 20;
constexpr int kMostRayResolutionPerScene = 4;  ///< of tables that every scene has its own of

double table_bytes(const CullingSetup& setup) {
  const double n = setup.masks.ray_resolution;
  const double row_bytes = 8.0 * cull::words_per_mask(setup.masks.resolution);
  if (setup.design == Design::MaskLut || setup.design == Design::Dedup) return n * n * n * n * n * n * row_bytes;
  return setup.design == Design::Projection ? n * n * n * n * 8 : 0;
}

/// Whether tables are made of the scene's own compression LUT.
bool has_own_tables(const CullingSetup& setup) {
  return setup.design == Design::BitTable || (setup.design == Design::Dedup && setup.masks.entries != 0);
}

void draw_resolutions(const SetupChoice& choice, CaseRandom& random, CullingSetup& setup) {
  const int most = has_own_tables(setup) ? kMostRayResolutionPerScene : cull::kMaxResolution;
  const int resolution = random.pick(cull::kMinResolution, most);
  setup.masks.resolution = choice.resolution.value_or(resolution);
  const int ray_resolution = random.pick(setup.masks.resolution, 2 * setup.masks.resolution);
  setup.masks.ray_resolution = std::max(choice.ray_resolution.value_or(ray_resolution), setup.masks.resolution);
  if (choice.ray_resolution) return;
  if (has_own_tables(setup))
    setup.masks.ray_resolution =
        std::max(std::min(setup.masks.ray_resolution, kMostRayResolutionPerScene), setup.masks.resolution);
  while (setup.masks.ray_resolution > setup.masks.resolution && table_bytes(setup) > kQuickTableBytes)
    --setup.masks.ray_resolution;
}

}  // namespace

std::string to_string(const CullingSetup& setup) {
  std::string text(cull::to_string(setup.design));
  const cull::MaskOptions& masks = setup.masks;
  if (setup.design != Design::None) {
    text += fmt::format(" R {}", masks.resolution);
    if (cull::reads_tables(setup.design)) text += fmt::format(", R_ray {}", masks.ray_resolution);
    text += masks.levels == cull::kUnlimitedLevels ? ", L inf" : fmt::format(", L {}", masks.levels);
    if (masks.entries != 0) text += fmt::format(", {} entries", masks.entries);
  }
  if (setup.box_bits != accel::kFullBoxBits) text += fmt::format(", boxes of {} bits", setup.box_bits);
  if (setup.primitive_boxes) text += ", ray boxes";
  if (setup.packets.any())
    text += fmt::format(", packets of {} with {} entries", setup.packets.size, setup.packets.most_entries);
  return text + fmt::format(", leaves of {}", setup.leaf_triangles);
}

std::vector<Design> all_designs() {
  return {Design::None,  Design::Ideal,      Design::MaskLut,    Design::BitTable,
          Design::Dedup, Design::Projection, Design::Comparators};
}

void validate(const SetupChoice& choice) {
  cull::MaskOptions masks;
  masks.resolution = choice.resolution.value_or(cull::kMinResolution);
  masks.ray_resolution = std::max(choice.ray_resolution.value_or(masks.resolution), masks.resolution);
  masks.levels = choice.levels.value_or(cull::kUnlimitedLevels);
  cull::validate(masks);
  if (choice.resolution && choice.ray_resolution && *choice.ray_resolution < *choice.resolution)
    throw Error("--r-ray", fmt::format("{} is below R = {}", *choice.ray_resolution, *choice.resolution),
                "a ray's key is at least as fine as the masks");
}

CullingSetup draw_setup(const SetupChoice& choice, CaseRandom& random) {
  constexpr int kLevels[] = {cull::kUnlimitedLevels, cull::kUnlimitedLevels, cull::kUnlimitedLevels, 1, 2, 3};
  constexpr int kLeaves[] = {1, 2, 4, 4, 8, 15};
  constexpr int kEntries[] = {16, 32, 64};
  constexpr std::uint32_t kReduced[] = {16, 12, 8};
  constexpr int kPacketSizes[] = {4, 8, 16, 32};
  CullingSetup setup;
  setup.design = choice.designs[static_cast<std::size_t>(random.below(static_cast<int>(choice.designs.size())))];
  const bool compressed = random.chance(0.125);
  const int entries = random.one_of(kEntries), levels = random.one_of(kLevels);
  setup.leaf_triangles = random.one_of(kLeaves);
  if (setup.design == Design::BitTable || (compressed && setup.design != Design::None)) setup.masks.entries = entries;
  setup.masks.levels = choice.levels.value_or(levels);
  draw_resolutions(choice, random, setup);
  const std::uint32_t reduced = random.one_of(kReduced),
                      box_bits = random.chance(0.125) ? reduced : accel::kFullBoxBits;
  setup.box_bits = choice.box_bits.value_or(box_bits);
  const bool primitive_boxes = random.chance(0.25);
  setup.primitive_boxes = choice.primitive_boxes.value_or(primitive_boxes);
  const bool packets = random.chance(0.125);
  const reference::PacketPlan plan{random.one_of(kPacketSizes), random.pick(1, choice.most_packet_entries)};
  if (choice.packets.value_or(packets)) setup.packets = plan;
  return setup;
}

std::shared_ptr<const cull::MaskTester> TesterCache::get(Design design, int resolution, int ray_resolution) {
  const std::lock_guard lock(mutex_);
  auto& tester = testers_[{design, resolution, ray_resolution}];
  if (!tester) {
    cull::MaskOptions options;
    options.resolution = resolution;
    options.ray_resolution = ray_resolution;
    tester = std::make_shared<const cull::MaskTester>(design, options);
  }
  return tester;
}

}  // namespace ctu::sim::check
