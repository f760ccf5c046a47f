// A Verilated tests/rtl/stages/lane_bench.sv, clocked: boxes enter one a cycle, and what leaves is compared with the
// slab test.
#pragma once

#include <verilated.h>

#include <cstdint>
#include <cstdio>
#include <deque>
#include <random>
#include <string>

#include "model/numeric/round.h"
#include "tests/intersect/hostile_boxes.h"

namespace ctu::rtl {

/// docs/unit.md: 4 subtract, 4 multiply, 3 compare.
inline constexpr std::size_t kLaneLatency = 11;

struct LaneRun {
  std::uint64_t compared = 0, hits = 0;
  std::string difference;  ///< empty: none
};

/// A box, and what the slab test says of it.
struct LaneCase {
  intersect::BoxCase box_case;
  int lane = 0;
  intersect::SlabTimes times;
};

template <class Model>
class VerilatedLane {
 public:
  /// `count` hostile cases of four lanes each, the enable withheld in one cycle of eight. Stops at the first
  /// difference.
  LaneRun run(std::uint64_t seed, int count) {
    LaneRun result;
    intersect::HostileBoxes hostile(seed);
    std::mt19937_64 random(seed + 1);
    std::deque<LaneCase> inside;  // the latest first
    for (int i = 0; i < count && result.difference.empty(); ++i) {
      const intersect::BoxCase box_case = hostile.next();
      const intersect::PreparedRay ray = intersect::prepare_ray(box_case.ray);
      if (!ray.valid) continue;
      const intersect::SlabTimes times = intersect::slab_test(ray, box_case.boxes, box_case.tmax);
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        set_inputs(ray, box_case, lane);
        while (!cycle(random() % 8 != 0)) {
        }
        inside.push_front({box_case, lane, times});
        if (inside.size() < kLaneLatency) continue;
        compare(inside.back(), result);
        inside.pop_back();
      }
    }
    return result;
  }

 private:
  void set_inputs(const intersect::PreparedRay& ray, const intersect::BoxCase& box_case, int lane) {
    using numeric::bits;
    for (int axis = 0; axis < 3; ++axis) {
      model_.lo_i[axis] = bits(box_case.boxes.lo[axis][lane]);
      model_.hi_i[axis] = bits(box_case.boxes.hi[axis][lane]);
      model_.origin_i[axis] = bits(ray.ray.origin[axis]);
      model_.rcp_down_i[axis] = bits(ray.rcp_down[axis]);
      model_.rcp_up_i[axis] = bits(ray.rcp_up[axis]);
    }
    model_.zero_axes_i = ray.zero_axes;
    model_.negative_axes_i = ray.negative_axes;
    model_.tmin_i = bits(ray.ray.tmin);
    model_.tmax_i = bits(box_case.tmax);
  }

  /// One clock; whether the registers moved.
  bool cycle(bool enable) {
    model_.enable_i = enable;
    model_.clk_i = 0;
    model_.eval();
    model_.clk_i = 1;
    model_.eval();
    return enable;
  }

  void compare(const LaneCase& expected, LaneRun& result) {
    const intersect::SlabTimes& times = expected.times;
    const int lane = expected.lane;
    const auto same = [&](const char* name, std::uint32_t is, std::uint32_t should) {
      if (is == should || !result.difference.empty()) return;
      char text[96];
      std::snprintf(text, sizeof text, "%s: the lane gave 0x%08x, slab_test 0x%08x", name, is, should);
      result.difference = text + show(expected.box_case, lane);
    };
    for (int axis = 0; axis < 3; ++axis) {
      same("near_down", model_.near_down_o[axis], numeric::bits(times.near_down[axis][lane]));
      same("near_up", model_.near_up_o[axis], numeric::bits(times.near_up[axis][lane]));
      same("far_down", model_.far_down_o[axis], numeric::bits(times.far_down[axis][lane]));
      same("far_up", model_.far_up_o[axis], numeric::bits(times.far_up[axis][lane]));
    }
    const std::uint32_t hit = times.hit >> lane & 1;
    same("t0", model_.t0_o, numeric::bits(times.t0[lane]));
    same("t1", model_.t1_o, numeric::bits(times.t1[lane]));
    same("hit", model_.hit_o, hit);
    same("t0 without inner bounds", model_.outer_t0_o, numeric::bits(times.t0[lane]));
    same("t1 without inner bounds", model_.outer_t1_o, numeric::bits(times.t1[lane]));
    same("hit without inner bounds", model_.outer_hit_o, hit);
    ++result.compared;
    result.hits += hit;
  }

  VerilatedContext context_;
  Model model_{&context_};
};

}  // namespace ctu::rtl
