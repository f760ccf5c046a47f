// rtl/packet_join.sv and rtl/packet_test_lane.sv against cull::packet::PacketSlabs: what a packet knows of a box, bit
// for bit, in its cycle, on packets and boxes that touch exactly or miss by a rounding.
#include <gtest/gtest.h>

#include <cstdlib>
#include <deque>
#include <iostream>
#include <limits>
#include <random>

#include "VMutantPacketOriginsSwapped.h"
#include "VPacketLane.h"
#include "model/cull/packet/packet_slabs.h"
#include "sim/check/packets/packet_case.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using cull::packet::PacketSlabs;
using cull::packet::PacketTimes;
using numeric::bits;

constexpr int kLatency = 11;  // docs/unit.md: 4 subtract, 4 multiply, 3 compare
constexpr int kTests = 6;     // of a packet
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Compared {
  std::string difference;
  std::uint64_t tests = 0, hits = 0, sure = 0, without_direction = 0;
};

void put(std::uint32_t* words, const Vec3& vector) { BitWriter(words).put(vector[0]).put(vector[1]).put(vector[2]); }

/// The box of the case, a part of it, one about a ray's origin, and one that is empty.
intersect::Box4 boxes_of(const sim::check::PacketCase& packet, int test) {
  intersect::Box4 boxes{};
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = packet.box.lo[axis], upper = packet.box.hi[axis];
    const float origin = packet.rays.front().origin[axis];
    boxes.lo[axis][0] = test == 1 ? lower / 2 + upper / 2 : test == 2 ? std::min(lower, origin) : lower;
    boxes.hi[axis][0] = test == 2 ? std::max(upper, origin) : upper;
    if (test == 3) boxes.lo[axis][0] = kInfinity, boxes.hi[axis][0] = -kInfinity;
    if (test == 4) boxes.lo[axis][0] = boxes.hi[axis][0] = lower;
    if (test == 5 && axis == 0) boxes.lo[axis][0] = boxes.hi[axis][0] = origin;
  }
  return boxes;
}

/// A Verilated packet_lane_bench, into which a box enters in each cycle.
template <class Model>
class LaneTwin {
 public:
  void join(const intersect::PreparedRay& ray, bool first) {
    model_.join_i = 1;
    model_.first_i = first;
    put(&model_.origin_i[0], ray.ray.origin);
    put(&model_.rcp_down_i[0], ray.rcp_down);
    put(&model_.rcp_up_i[0], ray.rcp_up);
    model_.zero_axes_i = ray.zero_axes;
    model_.negative_axes_i = ray.negative_axes;
    model_.tmin_i = bits(ray.ray.tmin);
    model_.tmax_i = bits(ray.ray.tmax);
    model_.enable_i = 0;
    model_.eval();
    clock(model_);
    model_.join_i = 0;
  }
  /// Lane 0 of `boxes` enters; what entered kLatency cycles ago is compared.
  void test(const intersect::Box4& boxes, const PacketTimes& times, bool enable, Compared& compared) {
    for (int axis = 0; axis < 3; ++axis) {
      model_.lo_i[axis] = bits(boxes.lo[axis][0]);
      model_.hi_i[axis] = bits(boxes.hi[axis][0]);
    }
    model_.enable_i = 0;
    model_.eval();
    if (!enable) clock(model_);  // nothing moves
    model_.enable_i = 1;
    model_.eval();
    clock(model_);
    inside_.push_back(times);
    if (inside_.size() < kLatency) return;
    const PacketTimes& leaving = inside_.front();
    difference_.same("hit", model_.hit_o, leaving.hit & 1u).same("sure", model_.sure_o, leaving.sure & 1u);
    difference_.same("t0", model_.t0_o, bits(leaving.t0[0]));
    compared.difference = difference_.take();
    ++compared.tests;
    compared.hits += leaving.hit & 1u;
    compared.sure += leaving.sure & 1u;
    inside_.pop_front();
  }

 private:
  std::deque<PacketTimes> inside_;
  Difference difference_;
  VerilatedContext context_;
  Model model_{from_noise(context_)};
};

/// Up to the first difference.
template <class Model>
Compared compare(std::uint64_t packets) {
  LaneTwin<Model> twin;
  std::mt19937_64 random(oracle::test_seed());
  Compared compared;
  const auto generators = static_cast<std::uint32_t>(sim::check::packet_generators().size());
  for (std::uint64_t number = 0; number < packets && compared.difference.empty(); ++number) {
    const sim::check::PacketCase packet = sim::check::make_packet_case(
        oracle::test_seed(), static_cast<std::uint32_t>(number % generators), number / generators);
    PacketSlabs slabs;
    unsigned moves[3] = {};
    for (const intersect::Ray& ray : packet.rays) {
      const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
      twin.join(prepared, slabs.empty());
      slabs.add(prepared);
      for (int axis = 0; axis < 3; ++axis)
        moves[axis] |= (prepared.zero_axes >> axis & 1) != 0 ? 1u : (prepared.negative_axes >> axis & 1) != 0 ? 2u : 4u;
    }
    for (const unsigned ways : moves) compared.without_direction += ways != 2 && ways != 4;
    for (int test = 0; test < kTests && compared.difference.empty(); ++test) {
      const intersect::Box4 boxes = boxes_of(packet, test);
      twin.test(boxes, slabs.test(boxes), random() % 8 != 0, compared);
    }
  }
  return compared;
}

TEST(PacketLane, knows_of_each_box_what_the_model_knows_of_it_to_the_bit_eleven_cycles_later) {
  SCOPED_TRACE(oracle::seed_note());
  const std::uint64_t packets = std::getenv("CTU_LONG_TESTS") != nullptr ? 300'000 : 12'000;
  const Compared compared = compare<VPacketLane>(packets);
  EXPECT_EQ(compared.difference, "") << "after " << compared.tests << " boxes";
  EXPECT_GT(compared.tests, kTests * packets - kLatency - 1);
  EXPECT_GT(compared.hits, compared.tests / 5);
  EXPECT_GT(compared.tests - compared.hits, compared.tests / 5);
  EXPECT_GT(compared.sure, compared.tests / 50);
  EXPECT_GT(compared.hits - compared.sure, compared.tests / 50);
  EXPECT_GT(compared.without_direction, packets / 5);
}

TEST(PacketLaneMutants, origins_that_are_no_outer_ones_where_rays_go_down_are_caught) {
  SCOPED_TRACE(oracle::seed_note());
  const Compared compared = compare<VMutantPacketOriginsSwapped>(2000);
  EXPECT_NE(compared.difference, "");
  std::cout << "box " << compared.tests << ", " << compared.difference << '\n';
}

}  // namespace
}  // namespace ctu::rtl
