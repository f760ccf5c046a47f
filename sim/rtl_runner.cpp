#include "sim/rtl_runner.h"

#include <algorithm>

#include "sim/cosim/lock_step.h"
#include "sim/cosim/rtl_builds.h"
#include "sim/cosim/rtl_result.h"
#include "sim/progress.h"

namespace ctu::sim {
namespace {

// Cycles drawn before and behind a difference.
constexpr pipeline::Cycle kBefore = 100, kBehind = 20;

class Both {
 public:
  Both(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan)
      : trace_(trace), tester_(tester), plan_(plan), image_(trace.unit_image(tester.design())) {}

  cosim::LockStepResult run(const cosim::LockStepOptions& options) const {
    traces::TraceFeed model_feed(trace_.reader(), plan_.range), rtl_feed(trace_.reader(), plan_.range);
    const pipeline::Work model_work{image_, tester_, model_feed}, rtl_work{image_, tester_, rtl_feed};
    const auto unit = cosim::make_rtl_unit(plan_.config, rtl_work);
    Progress bar("both twins", model_feed.total_rays(), "rays");
    cosim::LockStepOptions watched = options;
    watched.progress = [&](std::uint64_t rays) { bar.update(rays); };
    return cosim::run_lock_step(*unit, plan_.config, model_work, rtl_work, watched);
  }

 private:
  const LoadedTrace& trace_;
  const cull::MaskTester& tester_;
  const RunPlan& plan_;
  accel::Image image_;
};

}  // namespace

pipeline::UnitResult run_rtl(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan) {
  const accel::Image image = trace.unit_image(tester.design());
  traces::TraceFeed feed(trace.reader(), plan.range);
  const pipeline::Work work{image, tester, feed};
  const auto unit = cosim::make_rtl_unit(plan.config, work);
  Progress bar("rtl", feed.total_rays(), "rays");
  return cosim::run_rtl(*unit, plan.config, work, [&](std::uint64_t rays) { bar.update(rays); });
}

pipeline::UnitResult run_both(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan,
                              TwinComparison& comparison) {
  const Both both(trace, tester, plan);
  cosim::LockStepOptions options;
  options.stall_seed = plan.options.stall_seed;
  options.waves_prefix = plan.options.waves_path;
  options.waves_first = plan.options.waves_first;
  options.waves_last = plan.options.waves_last;
  const cosim::LockStepResult result = both.run(options);
  comparison.handshakes = result.handshakes;
  comparison.signals = result.compared;
  if (result.difference) {
    comparison.first_difference = cosim::to_string(*result.difference);
    if (options.waves_prefix.empty()) options.waves_prefix = "difference";
    options.waves_first = result.difference->cycle - std::min(kBefore, result.difference->cycle);
    options.waves_last = result.difference->cycle + kBehind;
    both.run(options);
    comparison.waves = options.waves_prefix;
  }
  pipeline::UnitResult unit = result.model;
  unit.wrong_hits = std::max(unit.wrong_hits, result.rtl_wrong_hits);
  return unit;
}

}  // namespace ctu::sim
