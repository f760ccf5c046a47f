// `ctusim check --compare`: the naive forms lose hits where they are known to, the safe ones never, and the counts are
// those of the scenes whatever the threads.
#include "sim/check/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "tests/oracle/seed.h"

namespace ctu::sim::check {
namespace {

CampaignOptions some_generators(std::initializer_list<std::string_view> names, std::uint64_t cases) {
  CampaignOptions options;
  options.seed = oracle::test_seed();
  for (std::uint32_t i = 0; i < generators().size(); ++i)
    if (std::find(names.begin(), names.end(), generators()[i].name) != names.end()) options.generators.push_back(i);
  options.budget.cases = cases;
  return options;
}

TEST(Comparison, plain_binary32_loses_hits_and_the_safe_forms_none) {
  SCOPED_TRACE(oracle::seed_note());
  const CampaignOptions options =
      some_generators({"flat-boxes", "origins-far-away", "one-time", "subnormal-scenes"}, 30000);
  const ComparisonResult result = compare_forms(options, {});
  ASSERT_EQ(result.by_generator.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const ComparisonRow& row = result.by_generator[i];
    EXPECT_GT(row.exact_hits, 1000u);
    EXPECT_GT(row.forms[0].lost, row.exact_hits / 1000) << generators()[options.generators[i]].name;
    for (std::size_t form = kNaiveForms; form < kForms.size(); ++form) EXPECT_EQ(row.forms[form].lost, 0u);
  }
  EXPECT_EQ(result.safe_forms_lost(), 0u);
}

TEST(Comparison, padding_of_times_keeps_what_lies_on_borders_and_not_what_has_no_digits_left) {
  SCOPED_TRACE(oracle::seed_note());
  const ComparisonResult borders = compare_forms(some_generators({"origins-on-cell-borders"}, 20000), {});
  EXPECT_GT(borders.by_generator[0].forms[0].lost, 0u);
  EXPECT_EQ(borders.by_generator[0].forms[2].lost, 0u);
  const ComparisonResult subnormal = compare_forms(some_generators({"subnormal-scenes"}, 20000), {});
  EXPECT_GT(subnormal.by_generator[0].forms[2].lost, subnormal.by_generator[0].exact_hits / 10);
}

TEST(Comparison, counts_the_same_for_any_number_of_threads) {
  SCOPED_TRACE(oracle::seed_note());
  CampaignOptions options = some_generators({"soup", "hair", "aspects"}, 6000);
  const ComparisonResult one = compare_forms(options, {});
  options.threads = 3;
  const ComparisonResult three = compare_forms(options, {});
  for (std::size_t i = 0; i < one.by_generator.size(); ++i) {
    EXPECT_EQ(one.by_generator[i].rays, three.by_generator[i].rays);
    EXPECT_EQ(one.by_generator[i].exact_hits, three.by_generator[i].exact_hits);
    for (std::size_t form = 0; form < kForms.size(); ++form) {
      EXPECT_EQ(one.by_generator[i].forms[form].lost, three.by_generator[i].forms[form].lost);
      EXPECT_EQ(one.by_generator[i].forms[form].culled, three.by_generator[i].forms[form].culled);
      EXPECT_EQ(one.by_generator[i].forms[form].tests, three.by_generator[i].forms[form].tests);
    }
  }
}

}  // namespace
}  // namespace ctu::sim::check
