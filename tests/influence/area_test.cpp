// Membership is conservative: what exact arithmetic says touches is never given up, what is called contained is.
#include "model/influence/area.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "model/base/error.h"
#include "tests/influence/exact_area.h"
#include "tests/influence/random_areas.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using influence::AreaKind;
using influence::InfluenceArea;
using influence::PreparedArea;
using test::AreaRandom;

std::string bits(const Vec3& v) {
  return fmt::format("({:08x} {:08x} {:08x})", std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y),
                     std::bit_cast<std::uint32_t>(v.z));
}
std::string bits(const InfluenceArea& a) {
  return fmt::format("{} area at {} axes {} {} {} halves {:08x} {:08x} from {:08x} to {:08x}", to_string(a.kind),
                     bits(a.origin), bits(a.axes[0]), bits(a.axes[1]), bits(a.axes[2]),
                     std::bit_cast<std::uint32_t>(a.half_x), std::bit_cast<std::uint32_t>(a.half_y),
                     std::bit_cast<std::uint32_t>(a.near), std::bit_cast<std::uint32_t>(a.far));
}

/// How often a conservative answer gave away what the exact one has.
struct Tally {
  int met = 0, missed = 0, given_away = 0;
};

struct Setting {
  const char* name;
  float scale, shift;
};
constexpr Setting kSettings[] = {{"near the origin", 1, 1},
                                 {"far from the origin", 1, 300},
                                 {"small", 0x1p-60f, 0x1p-60f},
                                 {"large", 0x1p90f, 0x1p90f}};

TEST(InfluenceArea, keeps_every_triangle_with_a_point_inside) {
  SCOPED_TRACE(oracle::seed_note());
  AreaRandom random(oracle::test_seed());
  for (const Setting& setting : kSettings) {
    Tally tally;
    for (int i = 0; i < 1500; ++i) {
      const InfluenceArea area = random.area(setting.scale, setting.shift);
      const Vec3 o = area.origin;
      const auto near_area = [&](float reach) {
        const Vec3 p = random.point(reach * setting.scale);
        return Vec3{o.x + p.x, o.y + p.y, o.z + p.z};
      };
      const Vec3 v0 = near_area(1.5f), v1 = near_area(1.5f), v2 = near_area(1.5f);
      const bool exact = test::exact_touches(area, v0, v1, v2), kept = PreparedArea(area).may_touch(v0, v1, v2);
      ++(exact ? tally.met : tally.missed);
      if (kept && !exact) ++tally.given_away;
      ASSERT_TRUE(kept || !exact) << bits(area) << " triangle " << bits(v0) << bits(v1) << bits(v2);
    }
    EXPECT_GT(tally.met, 200) << setting.name;
    EXPECT_GT(tally.missed, 200) << setting.name;
    EXPECT_LE(tally.given_away, 2) << setting.name << ": separating axes prove nearly all that is apart";
  }
}

TEST(InfluenceArea, keeps_every_box_with_a_point_inside) {
  SCOPED_TRACE(oracle::seed_note());
  AreaRandom random(oracle::test_seed() + 1);
  for (const Setting& setting : kSettings) {
    Tally tally;
    for (int i = 0; i < 1000; ++i) {
      const InfluenceArea area = random.area(setting.scale, setting.shift);
      const Vec3 from = random.point(1.5f * setting.scale);
      Vec3 lower, upper;
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = area.origin[axis] + from[axis];
        upper[axis] = lower[axis] + random.between(0, 1) * setting.scale;
      }
      const bool exact = test::exact_touches(area, lower, upper), kept = PreparedArea(area).may_touch(lower, upper);
      ++(exact ? tally.met : tally.missed);
      if (kept && !exact) ++tally.given_away;
      ASSERT_TRUE(kept || !exact) << bits(area) << " box " << bits(lower) << bits(upper);
    }
    EXPECT_GT(tally.met, 50) << setting.name;
    EXPECT_GT(tally.missed, 100) << setting.name;
    EXPECT_LE(tally.given_away, 2) << setting.name;
  }
}

TEST(InfluenceArea, keeps_what_touches_it_in_one_point_and_what_is_flat) {
  SCOPED_TRACE(oracle::seed_note());
  AreaRandom random(oracle::test_seed() + 2);
  Tally tally;
  for (int i = 0; i < 3000; ++i) {
    const InfluenceArea area = random.lattice_area();
    const PreparedArea prepared(area);
    const Vec3 a = random.lattice_point(6), b = random.lattice_point(6), c = random.lattice_point(6);
    if (test::exact_touches(area, a, b, c)) {
      ++tally.met;
      ASSERT_TRUE(prepared.may_touch(a, b, c)) << bits(area) << " triangle " << bits(a) << bits(b) << bits(c);
    }
    const Vec3 upper{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    const Vec3 lower{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    if (test::exact_touches(area, lower, upper)) {
      ASSERT_TRUE(prepared.may_touch(lower, upper)) << bits(area) << " box " << bits(lower) << bits(upper);
    } else {
      ++tally.missed;
      tally.given_away += prepared.may_touch(lower, upper) ? 1 : 0;
    }
  }
  EXPECT_GT(tally.met, 300);
  EXPECT_GT(tally.missed, 300);
  EXPECT_LT(tally.given_away * 10, tally.missed) << "flat areas have fewer axes than they would need";
}

TEST(InfluenceArea, calls_contained_only_what_is) {
  SCOPED_TRACE(oracle::seed_note());
  AreaRandom random(oracle::test_seed() + 3);
  for (const Setting& setting : kSettings) {
    int inside = 0, uncertain = 0;
    for (int i = 0; i < 3000; ++i) {
      const InfluenceArea area = random.area(setting.scale, setting.shift);
      const PreparedArea prepared(area);
      const Vec3 offset = random.point(setting.scale), direction = random.point(1);
      const Vec3 p{area.origin.x + offset.x, area.origin.y + offset.y, area.origin.z + offset.z};
      const intersect::Ray ray{p, 0, direction, 0};
      const float t = random.between(0, 1) * setting.scale;
      for (const bool along : {false, true}) {
        const bool exact = along ? test::exact_contains(area, ray, t) : test::exact_contains(area, p);
        const bool certain = along ? prepared.certainly_contains(ray, t) : prepared.certainly_contains(p);
        inside += exact ? 1 : 0;
        uncertain += exact && !certain ? 1 : 0;
        ASSERT_TRUE(exact || !certain) << bits(area) << " point " << bits(p) << " direction " << bits(direction)
                                       << " t " << std::bit_cast<std::uint32_t>(t);
      }
    }
    EXPECT_GT(inside, 200) << setting.name;
    EXPECT_LE(uncertain, 2) << setting.name;
  }
}

TEST(InfluenceArea, of_the_paper_has_the_axes_of_appendix_a5) {
  InfluenceArea area;
  area.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  area.half_x = area.half_y = area.far = 1;
  EXPECT_EQ(PreparedArea(area).body().normals, 3u);
  EXPECT_EQ(PreparedArea(area).body().edges, 3u);
  area.kind = AreaKind::Point;
  EXPECT_EQ(PreparedArea(area).body().normals, 5u);
  EXPECT_EQ(PreparedArea(area).body().edges, 6u);
}

TEST(InfluenceArea, refuses_what_is_none) {
  InfluenceArea good;
  good.axes = influence::frame_along({1, 2, 3}, {0, 1, 0});
  good.half_x = good.half_y = good.far = 1;
  EXPECT_NO_THROW(PreparedArea{good});
  const auto refuse = [&](auto&& spoil) {
    InfluenceArea area = good;
    spoil(area);
    EXPECT_THROW(PreparedArea{area}, Error);
  };
  refuse([](InfluenceArea& a) { a.origin.y = std::numeric_limits<float>::quiet_NaN(); });
  refuse([](InfluenceArea& a) { a.far = std::numeric_limits<float>::infinity(); });
  refuse([](InfluenceArea& a) { a.axes[1] = a.axes[0]; });
  refuse([](InfluenceArea& a) { a.half_x = -1; });
  refuse([](InfluenceArea& a) { a.near = 2; });
  refuse([](InfluenceArea& a) { a.kind = AreaKind::Point, a.near = -1; });
}

}  // namespace
}  // namespace ctu
