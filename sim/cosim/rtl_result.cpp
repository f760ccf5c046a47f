#include "sim/cosim/rtl_result.h"

#include <bit>

#include "model/pipeline/engine.h"

namespace ctu::cosim {
namespace {

using pipeline::Activity;
using pipeline::Cycle;

constexpr std::initializer_list<Activity> kAllCauses = {
    Activity::OutputFull, Activity::NoContext, Activity::BankConflict, Activity::MshrsFull, Activity::MemoryPortFull,
    Activity::FillPort,   Activity::Memory,    Activity::Spill,        Activity::Interval,  Activity::NoPacket};

constexpr int place_of_link(std::string_view name) {
  int place = 0;
  while (kLinkNames[static_cast<std::size_t>(place)] != name) ++place;
  return place;
}
constexpr int kNodeToBox = place_of_link("node_to_box"), kBoxToLocate = place_of_link("box_to_locate"),
              kBoxToSort = place_of_link("box_to_sort"), kMaskToSort = place_of_link("mask_to_sort"),
              kLeafToTriangle = place_of_link("leaf_to_triangle"), kLeafToCull = place_of_link("leaf_to_cull"),
              kTriangleToHit = place_of_link("triangle_to_hit"),
              kTriangleToSphere = place_of_link("triangle_to_sphere");

// Fields of a node token (token_bits.h).
unsigned hits(const LinkState& link) { return link.token[0] >> 16 & 15u; }
unsigned survivors(const LinkState& link) { return link.token[0] >> 12 & 15u; }

bool anything_pushed(const RtlUnit& unit) {
  for (int link = 0; link < kLinks; ++link)
    if (unit.link(link).pushed) return true;
  return false;
}

}  // namespace

RtlObserver::RtlObserver(const RtlParameters& build) {
  const bool has_mask_test = build.design != cull::Design::None;
  for (int stage = 0; stage < kStages; ++stage) {
    const std::string_view name = kStageNames[static_cast<std::size_t>(stage)];
    if (!has_mask_test && (name == "cell_locate" || name == "mask_test")) continue;
    if (!build.table_cache && name == "table_fetch") continue;
    if (!build.primitive_boxes && name == "primitive_cull") continue;
    if (!build.spheres && name == "sphere_test") continue;
    if (build.packets == 0 && name == "packet_cull") continue;
    stages_.push_back(stage);
    accounts_.emplace_back(name, kAllCauses);
  }
}

void RtlObserver::sample(const RtlUnit& unit) {
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const int activity = unit.activity(stages_[i]);
    accounts_[i].set(activity < pipeline::kActivities ? static_cast<Activity>(activity) : Activity::Idle);
  }
  counts_.node_visits += unit.link(kNodeToBox).pushed;
  counts_.leaf_visits += unit.link(kLeafToTriangle).pushed || unit.link(kLeafToCull).pushed;
  counts_.triangle_tests += unit.link(kTriangleToHit).pushed || unit.link(kTriangleToSphere).pushed;
  for (const int link : {kBoxToLocate, kBoxToSort}) {
    const LinkState tested = unit.link(link);
    if (tested.pushed) counts_.box_hits += static_cast<unsigned>(std::popcount(hits(tested)));
  }
  const LinkState passed = unit.link(kMaskToSort);
  if (passed.pushed) counts_.culled += static_cast<unsigned>(std::popcount(hits(passed) & ~survivors(passed)));
}

pipeline::UnitResult RtlObserver::result(const RtlRun& run) const {
  pipeline::UnitResult result;
  result.cycles = run.cycles();
  result.rays = run.rays();
  result.wrong_hits = run.wrong_hits();
  result.first_wrong = run.first_wrong();
  result.counts = counts_;
  result.counts.rays = run.rays();
  for (const pipeline::Account& account : accounts_) result.stages.push_back(account.close());
  return result;
}

pipeline::UnitResult run_rtl(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& work,
                             const std::function<void(std::uint64_t rays_done)>& progress) {
  std::array<int, kLinks> no_stalls;
  no_stalls.fill(-1);
  RtlRun run(unit, config, work, {}, no_stalls);
  RtlObserver observer(unit.parameters());
  Cycle last_moved = 0;
  std::uint64_t rays = 0;
  while (!run.done()) {
    run.begin();
    observer.sample(run.unit());
    if (anything_pushed(run.unit())) last_moved = run.cycles();
    run.end();
    if (run.rays() != rays) {
      rays = run.rays();
      if (progress && rays % 64 == 0) progress(rays);
    }
    if (run.cycles() - last_moved > static_cast<Cycle>(config.watchdog.cycles))
      throw pipeline::DeadlockFound("no link of the RTL unit has moved for watchdog.cycles");
  }
  return observer.result(run);
}

}  // namespace ctu::cosim
