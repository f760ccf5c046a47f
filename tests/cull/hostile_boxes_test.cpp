// The cells of the rays and boxes that break slab tests: coordinates of any exponent, subnormal directions, bounds that
// overflow to infinity.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "model/cull/cell_locate.h"
#include "model/cull/comparators.h"
#include "model/cull/ideal.h"
#include "model/cull/options.h"
#include "tests/cull/exact_points.h"
#include "tests/intersect/hostile_boxes.h"
#include "tests/oracle/exact_cells.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using Words = std::array<std::uint64_t, words_per_mask(kMaxResolution)>;

bool holds(const Words& words, const std::vector<std::uint8_t>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] != 0 && (words[i / 64] >> (i % 64) & 1) == 0) return false;
  return true;
}

TEST(HostileBoxes, no_touched_cell_is_lost_and_certain_keys_hold_the_exact_cells) {
  SCOPED_TRACE(oracle::seed_note());
  intersect::HostileBoxes make(oracle::test_seed());
  int certain = 0;
  for (int i = 0; i < 12000; ++i) {
    const intersect::BoxCase c = make.next();
    const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
    if (!ray.valid) continue;
    const intersect::SlabTimes times = intersect::slab_test(ray, c.boxes, c.tmax);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      if ((times.hit >> lane & 1) == 0) continue;
      const int r = kMinResolution + (i + lane) % (kMaxResolution - kMinResolution + 1);
      SCOPED_TRACE("R " + std::to_string(r) + ": " + show(c, lane));
      const Vec3 lo{c.boxes.lo[0][lane], c.boxes.lo[1][lane], c.boxes.lo[2][lane]};
      const Vec3 hi{c.boxes.hi[0][lane], c.boxes.hi[1][lane], c.boxes.hi[2][lane]};

      Words words{};
      comparator_mask(ray, times, c.boxes, lane, r, words.data());
      ASSERT_TRUE(holds(words, oracle::exact_ray_cells(c.ray, lo, hi, r, c.ray.tmin, c.tmax)));
      ideal_mask(ray, times, c.boxes, lane, r, words.data());
      ASSERT_TRUE(holds(words, oracle::exact_ray_cells(c.ray, lo, hi, r, c.ray.tmin, c.tmax, oracle::Cells::HalfOpen)));

      const int n = r + (i + 3 * lane) % (2 * r + 1);  // R_ray from R to 3R
      const CellKey key = cell_locate(ray, times, c.boxes, lane, n);
      const test::ExactOverlap exact = test::exact_overlap_cells(c.ray, lo, hi, n, c.ray.tmin, c.tmax);
      if (key.uncertain() || !exact.hit) continue;
      ++certain;
      ASSERT_TRUE(test::holds(key, exact.begin, exact.end));
    }
  }
  EXPECT_GT(certain, 1000);
  RecordProperty("certain", certain);
}

}  // namespace
}  // namespace ctu::cull
