#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/check/recorded_rays.h"
#include "sim/check/unit_execution.h"
#include "sim/check/unit_timing.h"
#include "sim/cosim/rtl_builds.h"
#include "sim/cosim/rtl_result.h"

namespace ctu::sim::check {
namespace {

std::vector<std::unique_ptr<cosim::RtlUnit>> units_at_hand() {
  std::vector<std::unique_ptr<cosim::RtlUnit>> units;
  for (const std::string& library : cosim::rtl_libraries()) units.push_back(cosim::load_rtl_unit(library));
  if (units.empty()) throw Error("--engine rtl", "no build of the RTL unit is there", "build them: `./dev rtl`");
  return units;
}

class RtlExecution : public Execution {
 public:
  Answers run(const CheckScene& scene, CaseRandom& random) override {
    const accel::Image image = image_of(scene);
    const auto recorded = record_rays(scene);
    std::string reasons;
    for (const auto& unit : units_) {
      pipeline::UnitConfig config = cosim::config_of(unit->parameters());
      config.mask_test.design = scene.setup.design;  // or a scene without masks would suit a build that reads them
      CaseRandom timing = random;
      draw_short_timing(timing, config);
      config.unit.contexts = std::max(config.unit.contexts, scene.setup.packets.size);
      OneBlockFeed feed(recorded, scene.setup.packets);
      const pipeline::Work work{image, *scene.tester, feed};
      const std::string reason = cosim::misfit(unit->parameters(), config, work);
      if (reason.empty()) return answers_of(cosim::run_rtl(*unit, config, work, {}), *recorded);
      reasons += fmt::format("\n  {}: {}", unit->parameters().name, reason);
    }
    throw Error("--engine rtl", "no build has this setup:" + reasons, "choose a design and R that a build has");
  }

 private:
  std::vector<std::unique_ptr<cosim::RtlUnit>> units_ = units_at_hand();
};

bool has_what_is_chosen(const cosim::RtlParameters& build, const SetupChoice& choice) {
  if (build.spheres) return false;  // the cases have none
  if (choice.box_bits && *choice.box_bits != build.box_bits) return false;
  if (std::find(choice.designs.begin(), choice.designs.end(), build.design) == choice.designs.end()) return false;
  if (build.design == cull::Design::None) return true;
  if (choice.resolution && *choice.resolution != build.resolution) return false;
  return !choice.ray_resolution || !cull::reads_tables(build.design) || *choice.ray_resolution == build.ray_resolution;
}

}  // namespace

std::unique_ptr<Execution> make_rtl_execution() { return std::make_unique<RtlExecution>(); }

DrawSetup draw_rtl_setup(const SetupChoice& choice) {
  std::vector<cosim::RtlParameters> builds;
  for (const auto& unit : units_at_hand())
    if (has_what_is_chosen(unit->parameters(), choice)) builds.push_back(unit->parameters());
  if (builds.empty())
    throw Error("--engine rtl", "no build of the RTL unit has this design, R, R_ray and bits of boxes",
                "choose others, or add a build to sim/cosim/builds.cmake");
  return [builds, choice](CaseRandom& random) {
    const cosim::RtlParameters& build = builds[static_cast<std::size_t>(random.below(static_cast<int>(builds.size())))];
    SetupChoice fixed = choice;
    fixed.designs = {build.design};
    fixed.resolution = build.resolution;
    fixed.ray_resolution = build.ray_resolution;
    fixed.box_bits = build.box_bits;
    fixed.primitive_boxes = build.primitive_boxes;
    fixed.packets = build.packets > 0;
    if (build.packets > 0) fixed.most_packet_entries = build.packet_entries;
    CullingSetup setup = draw_setup(fixed, random);
    const auto bytes = static_cast<int>(accel::primitive_bytes({.primitive_boxes = build.primitive_boxes}));
    setup.leaf_triangles = std::min(setup.leaf_triangles, build.max_leaf_bytes / bytes);
    setup.masks.entries = build.entries == 0 ? 0 : std::min(build.entries, std::max(setup.masks.entries, 16));
    return setup;
  };
}

}  // namespace ctu::sim::check
