// The octree names every area that contains a point, and few that do not.
#include "model/influence/octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/influence/exact_area.h"
#include "tests/influence/random_areas.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using influence::AreaOctree;
using influence::PreparedArea;

TEST(AreaOctree, never_misses_an_area) {
  SCOPED_TRACE(oracle::seed_note());
  test::AreaRandom random(oracle::test_seed() + 10);
  std::size_t named = 0, inside = 0;
  for (const int count : {1, 8, 20}) {
    std::vector<PreparedArea> areas;
    for (int i = 0; i < count; ++i) areas.emplace_back(random.area(2, 1));
    const AreaOctree octree(areas, {-2, -2, -2}, {2, 2, 2});
    for (int i = 0; i < 1500; ++i) {
      const Vec3 p = i % 3 == 0 ? Vec3{random.whole(-8, 8) * 0.25f, random.whole(-8, 8) * 0.25f, random.between(-2, 2)}
                                : random.point(2.5f);  // some on the cells' borders, some outside
      const auto found = octree.at(p);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      const bool in_box = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 2;
      if (in_box) named += found.size();
      for (std::uint32_t a = 0; a < areas.size(); ++a) {
        if (!test::exact_contains(areas[a].area(), p)) continue;
        inside += in_box ? 1 : 0;
        ASSERT_NE(std::find(found.begin(), found.end(), a), found.end()) << "area " << a;
      }
    }
  }
  EXPECT_GT(inside, 500u);
  EXPECT_LT(named, 2 * inside) << "it should name few areas in vain";
}

TEST(AreaOctree, divides_only_where_areas_end) {
  influence::InfluenceArea all;
  all.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  all.half_x = all.half_y = 9;
  all.near = -9;
  all.far = 9;
  const std::vector<PreparedArea> around{PreparedArea(all)};
  EXPECT_EQ(AreaOctree(around, {-1, -1, -1}, {1, 1, 1}).cells(), 1u);
  all.half_x = all.half_y = 0.3f;
  const std::vector<PreparedArea> thin{PreparedArea(all)};
  EXPECT_EQ(AreaOctree(thin, {-1, -1, -1}, {1, 1, 1}, 1).cells(), 9u);
  EXPECT_EQ(AreaOctree({}, {-1, -1, -1}, {1, 1, 1}).cells(), 1u);
  EXPECT_TRUE(AreaOctree({}, {-1, -1, -1}, {1, 1, 1}).at({5, 0, 0}).empty());
}

}  // namespace
}  // namespace ctu
