// The search: smaller never slower than allowed, the same for any number of threads, and not fooled by a unit that is
// larger than its scene.
#include "sim/tailor/search.h"

#include <gtest/gtest.h>

#include "sim/config_file.h"
#include "tests/sim/program.h"

namespace {

using namespace ctu::tailor;
using ctu::pipeline::UnitConfig;
using ctu::test::run_program;
using ctu::test::ScratchFolder;

class TailorSearch : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    const auto outcome =
        run_program(folder_->path(),
                    "record 'gen:hair-ball?strands=60&seed=5' -o hair.ctut --size 16x16 --rays diffuse --bounces 1");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::vector<std::string> traces() { return {(folder_->path() / "hair.ctut").string()}; }
  /// Small enough that its search is short.
  static UnitConfig start() {
    UnitConfig config;
    config.unit.contexts = 16;
    config.node_cache = {.bytes = 4096, .ways = 2, .mshrs = 4};
    config.leaf_cache = {.bytes = 4096, .ways = 2, .mshrs = 4};
    return config;
  }

  static ScratchFolder* folder_;
};
ScratchFolder* TailorSearch::folder_ = nullptr;

TEST_F(TailorSearch, what_it_finds_is_smaller_and_within_the_slowdown) {
  Workbench bench(traces(), 0);
  const std::uint64_t before = bench.run(start()).cycles.front();
  double area = bench.area(start());
  for (const double slowdown : {0.0, 0.02, 0.5}) {
    const SearchResult found = find_smallest(bench, start(), {.slowdown = slowdown, .restarts = 1});
    EXPECT_LE(static_cast<double>(bench.run(found.config).cycles.front()),
              static_cast<double>(before) * (1 + slowdown));
    EXPECT_LE(found.area, area) << "more time must not make it larger";
    EXPECT_DOUBLE_EQ(found.area, bench.area(found.config));
    area = found.area;
  }
  EXPECT_LT(area, 0.7 * bench.area(start()));
}

TEST_F(TailorSearch, no_single_key_of_the_result_can_still_shrink) {
  Workbench bench(traces(), 0);
  const SearchResult found = find_smallest(bench, start(), {.slowdown = 0.02, .restarts = 1});
  const double most = static_cast<double>(bench.run(start()).cycles.front()) * 1.02;
  for (const Dimension& dimension : dimensions_of(start(), found.config.mask_test.design))
    for (const auto& value : dimension.values) {
      const UnitConfig other = with_value(found.config, dimension.key, value);
      const Trial& trial = bench.run(other);
      if (!trial.ran() || static_cast<double>(trial.cycles.front()) > most) continue;
      EXPECT_GE(bench.area(other), found.area) << dimension.key;
    }
}

TEST_F(TailorSearch, threads_change_nothing) {
  Workbench one(traces(), 0), two(traces(), 0);
  const SearchResult a = find_smallest(one, start(), {.slowdown = 0.05, .restarts = 2, .threads = 1});
  const SearchResult b = find_smallest(two, start(), {.slowdown = 0.05, .restarts = 2, .threads = 3});
  EXPECT_EQ(ctu::sim::config_hash(a.config), ctu::sim::config_hash(b.config));
}

TEST_F(TailorSearch, latencies_and_memory_are_not_the_units_to_shrink) {
  for (const auto design : {ctu::cull::Design::Projection, ctu::cull::Design::Comparators, ctu::cull::Design::None})
    for (const Dimension& dimension : dimensions_of(UnitConfig{}, design)) {
      EXPECT_EQ(dimension.key.find("latency"), std::string::npos) << dimension.key;
      EXPECT_NE(dimension.key.substr(0, 7), "memory.") << dimension.key;
    }
}

}  // namespace
