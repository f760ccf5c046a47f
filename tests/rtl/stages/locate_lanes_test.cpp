// rtl/cell_locate_lane.sv and rtl/comparator_lane.sv against cull::cell_locate and cull::comparator_mask on hostile
// boxes, bit for bit, in the cycle in which each result is due.
#include <gtest/gtest.h>
#include <verilated.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <random>
#include <span>
#include <string>

#include "VLocateLanes.h"
#include "VMutantCellsNeverTouched.h"
#include "VMutantFlatBox.h"
#include "VMutantFractionSticky.h"
#include "VMutantKeysOfZeros.h"
#include "VMutantNoColumn.h"
#include "VMutantPlanesMetArePassed.h"
#include "VMutantWeightInwards.h"
#include "model/cull/cell_locate.h"
#include "model/cull/comparators.h"
#include "model/numeric/round.h"
#include "tests/intersect/hostile_boxes.h"
#include "tests/oracle/seed.h"

namespace ctu::rtl {
namespace {

/// A lane of locate_lanes_bench.sv: what it computes, when, and where its words lie.
struct LaneOfBench {
  const char* name;
  bool mask;
  int resolution;
  std::size_t latency;
  int first_word, words;
};
constexpr LaneOfBench kLanes[] = {{"key of R_ray 4", false, 4, 10, 0, 1}, {"key of R_ray 5", false, 5, 0, 1, 1},
                                  {"key of R_ray 6", false, 6, 3, 2, 1},  {"key of R_ray 8", false, 8, 23, 3, 1},
                                  {"mask of R 4", true, 4, 12, 4, 2},     {"mask of R 6", true, 6, 5, 6, 7}};
constexpr LaneOfBench kFewLanes[] = {{"key of R_ray 3", false, 3, 0, 1, 1}, {"mask of R 3", true, 3, 12, 4, 2}};
constexpr std::size_t kLongest = 23;
constexpr int kWords = 13;

struct Case {
  intersect::BoxCase box_case;
  int lane = 0;
  std::array<std::uint32_t, kWords> words{};
};

struct LanesRun {
  std::uint64_t compared = 0, uncertain = 0, one_cell = 0;
  std::string difference;  ///< empty: none
};

/// What the model says of a lane, as the bench lays it out.
std::array<std::uint32_t, kWords> model_words(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                                              const intersect::Box4& boxes, int lane,
                                              std::span<const LaneOfBench> lanes) {
  std::array<std::uint32_t, kWords> words{};
  for (const LaneOfBench& bench : lanes) {
    const auto at = static_cast<std::size_t>(bench.first_word);
    if (!bench.mask) {
      const std::uint32_t key = cull::cell_locate(ray, times, boxes, lane, bench.resolution).packed;
      words[at] = (key & 0x3fffffffu) | key >> 31 << 30;
      continue;
    }
    std::uint64_t mask[4] = {};
    cull::comparator_mask(ray, times, boxes, lane, bench.resolution, mask);
    for (int word = 0; word < bench.words; ++word)
      words[at + static_cast<std::size_t>(word)] = static_cast<std::uint32_t>(mask[word / 2] >> (32 * (word % 2)));
  }
  return words;
}

template <class Model>
class VerilatedLanes {
 public:
  /// `count` hostile cases, of which each lane hit enters, the enable withheld in one cycle of eight. Stops at the
  /// first difference in one of `lanes`.
  LanesRun run(std::uint64_t seed, int count, std::span<const LaneOfBench> lanes) {
    LanesRun result;
    intersect::HostileBoxes hostile(seed);
    std::mt19937_64 random(seed + 1);
    std::deque<Case> inside;  // the latest first
    for (int i = 0; i < count && result.difference.empty(); ++i) {
      const intersect::BoxCase box_case = hostile.next();
      const intersect::PreparedRay ray = intersect::prepare_ray(box_case.ray);
      if (!ray.valid) continue;
      const intersect::SlabTimes times = intersect::slab_test(ray, box_case.boxes, box_case.tmax);
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        if ((times.hit >> lane & 1) == 0) continue;
        set_inputs(ray, times, box_case.boxes, lane);
        while (random() % 8 == 0) stand();
        inside.push_front({box_case, lane, model_words(ray, times, box_case.boxes, lane, lanes)});
        model_.eval();
        for (const LaneOfBench& bench : lanes) compare(bench, inside, result);
        count_kinds(inside.front().words[static_cast<std::size_t>(lanes.front().first_word)], result);
        if (inside.size() > kLongest) inside.pop_back();
        cycle(true);
      }
    }
    return result;
  }

 private:
  void set_inputs(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                  int lane) {
    using numeric::bits;
    for (int axis = 0; axis < 3; ++axis) {
      model_.lo_i[axis] = bits(boxes.lo[axis][lane]);
      model_.hi_i[axis] = bits(boxes.hi[axis][lane]);
      model_.origin_i[axis] = bits(ray.ray.origin[axis]);
      model_.near_down_i[axis] = bits(times.near_down[axis][lane]);
      model_.near_up_i[axis] = bits(times.near_up[axis][lane]);
      model_.far_down_i[axis] = bits(times.far_down[axis][lane]);
      model_.far_up_i[axis] = bits(times.far_up[axis][lane]);
    }
    model_.zero_axes_i = ray.zero_axes;
    model_.negative_axes_i = ray.negative_axes;
    model_.t0_i = bits(times.t0[lane]);
    model_.t1_i = bits(times.t1[lane]);
  }

  void stand() { cycle(false); }
  void cycle(bool enable) {
    model_.enable_i = enable;
    model_.clk_i = 1;
    model_.eval();
    model_.clk_i = 0;
    model_.eval();
  }

  /// The case that entered `latency` enabled cycles ago is at the output.
  void compare(const LaneOfBench& bench, const std::deque<Case>& inside, LanesRun& result) {
    if (inside.size() <= bench.latency || !result.difference.empty()) return;
    const Case& due = inside[bench.latency];
    for (int word = bench.first_word; word < bench.first_word + bench.words; ++word) {
      const std::uint32_t is = model_.result_o[word], should = due.words[static_cast<std::size_t>(word)];
      if (is == should) continue;
      char text[128];
      std::snprintf(text, sizeof text, "%s, word %d: the lane gave 0x%08x, the model 0x%08x", bench.name,
                    word - bench.first_word, is, should);
      result.difference = text + show(due.box_case, due.lane);
      return;
    }
    ++result.compared;
  }

  static void count_kinds(std::uint32_t key, LanesRun& result) {
    result.uncertain += key >> 30 & 1;
    result.one_cell += (key >> 15 & 0x7fff) == (key & 0x7fff);
  }

  VerilatedContext context_;
  Model model_{&context_};
};

TEST(LocateLanes, give_the_keys_and_masks_of_the_model_in_the_cycle_in_which_they_are_due) {
  SCOPED_TRACE(oracle::seed_note());
  const int cases = std::getenv("CTU_LONG_TESTS") ? 1'000'000 : 150'000;
  VerilatedLanes<VLocateLanes> lanes;
  const LanesRun run = lanes.run(oracle::test_seed(), cases, kLanes);
  EXPECT_EQ(run.difference, "") << "after " << run.compared << " results";
  EXPECT_GT(run.compared, static_cast<std::uint64_t>(cases));
  EXPECT_GT(run.uncertain, run.compared / 1000);
  EXPECT_LT(run.uncertain + run.one_cell, run.compared / 6);
  std::cout << run.compared << " results; of the keys of R_ray 4 " << run.uncertain << " uncertain, " << run.one_cell
            << " of one cell\n";
}

template <class Model>
void expect_caught() {
  SCOPED_TRACE(oracle::seed_note());
  VerilatedLanes<Model> lanes;
  const LanesRun run = lanes.run(oracle::test_seed(), 60'000, kFewLanes);
  EXPECT_NE(run.difference, "");
  std::cout << "result " << run.compared << ", " << run.difference << '\n';
}

TEST(LocateLanesMutants, a_weight_chosen_without_a_look_at_the_sign_is_caught) {
  expect_caught<VMutantWeightInwards>();
}
TEST(LocateLanesMutants, a_product_whose_last_places_are_lost_is_caught) { expect_caught<VMutantFractionSticky>(); }
TEST(LocateLanesMutants, a_plane_just_met_that_counts_as_passed_whatever_the_direction_is_caught) {
  expect_caught<VMutantPlanesMetArePassed>();
}
TEST(LocateLanesMutants, a_flat_box_that_is_cut_into_cells_is_caught) { expect_caught<VMutantFlatBox>(); }
TEST(LocateLanesMutants, a_doubt_that_never_becomes_a_column_is_caught) { expect_caught<VMutantNoColumn>(); }
TEST(LocateLanesMutants, cells_that_the_ray_is_never_in_but_that_meet_others_are_caught) {
  expect_caught<VMutantCellsNeverTouched>();
}
TEST(LocateLanesMutants, zeros_that_order_by_their_sign_are_caught) { expect_caught<VMutantKeysOfZeros>(); }

}  // namespace
}  // namespace ctu::rtl
