// The largest tables, only when CTU_LONG_TESTS is set: some gigabytes and tens of seconds.
#include <gtest/gtest.h>

#include <cstdlib>

#include "model/cull/projection_table.h"
#include "model/cull/ray_mask_table.h"

namespace ctu::cull {
namespace {

class LargeTables : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(LargeTables, projections_and_table_agree_on_every_key) {
  if (std::getenv("CTU_LONG_TESTS") == nullptr) GTEST_SKIP() << "set CTU_LONG_TESTS to run";
  const auto [resolution, ray_resolution] = GetParam();
  const RayMaskTable table(resolution, ray_resolution);
  const ProjectionTable projections(resolution, ray_resolution);
  std::vector<std::uint64_t> words(static_cast<std::size_t>(table.words()));
  for (std::uint32_t row = 0; row < table.rows(); ++row) {
    const CellKey key = numbered_key(row, ray_resolution);
    projections.ray_mask(key, words.data());
    ASSERT_TRUE(std::equal(words.begin(), words.end(), table.row(row))) << "key " << std::hex << key.packed;
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, LargeTables,
                         testing::Values(std::pair{4, 16}, std::pair{6, 12}, std::pair{5, 11}, std::pair{7, 13},
                                         std::pair{8, 15}));

}  // namespace
}  // namespace ctu::cull
