#include <algorithm>
#include <mutex>

#include "model/unit/run.h"
#include "sim/check/recorded_rays.h"
#include "sim/check/unit_execution.h"
#include "sim/check/unit_timing.h"

namespace ctu::sim::check {
namespace {

unit::RunOptions draw_options(CaseRandom& random) {
  unit::RunOptions options;
  options.source = unit::Source::Exec;
  const int mode = random.below(32);
  options.mode = mode == 0 ? unit::Mode::Pins : mode < 4 ? unit::Mode::Cycle : unit::Mode::Batch;
  if (random.chance(0.25)) options.stall_seed = random.bits() | 1u;
  return options;
}

class CycleExecution : public Execution {
 public:
  Answers run(const CheckScene& scene, CaseRandom& random) override {
    pipeline::UnitConfig config;
    config.mask_test.design = scene.setup.design;
    draw_timing(random, cull::reads_tables(scene.setup.design), config);
    const unit::RunOptions options = draw_options(random);
    const accel::Image image = image_of(scene);
    const auto recorded = record_rays(scene);
    config.unit.contexts = std::max(config.unit.contexts, scene.setup.packets.size);
    OneBlockFeed feed(recorded, scene.setup.packets);
    static std::mutex kernel;
    const std::lock_guard lock(kernel);
    return answers_of(unit::run(config, {image, *scene.tester, feed}, options), *recorded);
  }
};

}  // namespace

std::unique_ptr<Execution> make_cycle_execution() { return std::make_unique<CycleExecution>(); }

}  // namespace ctu::sim::check
