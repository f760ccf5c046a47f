#include <gtest/gtest.h>

#include <vector>

#include "tests/numeric/flag_kernel.h"
#include "tests/numeric/operands.h"
#include "tests/oracle/seed.h"

namespace ctu::numeric {
namespace {

struct Operands {
  std::vector<float> a, b;

  Operands() {
    std::vector<Pair> pairs = operand_pairs(oracle::test_seed() + 2, 300'000);
    pairs.resize(pairs.size() / 4 * 4);
    for (const auto& [first, second] : pairs) {
      a.push_back(first);
      b.push_back(second);
    }
  }
};

std::vector<std::uint32_t> results(NumericKernel kernel, const Operands& operands) {
  std::vector<std::uint32_t> out(operands.a.size() * kResultsPerPair);
  kernel(operands.a.data(), operands.b.data(), operands.a.size(), out.data());
  return out;
}

void expect_same(const std::vector<std::uint32_t>& is, const std::vector<std::uint32_t>& should, const Operands& from) {
  SCOPED_TRACE(oracle::seed_note());
  for (std::size_t i = 0; i < is.size(); ++i) {
    const std::size_t pair = i % from.a.size();
    ASSERT_EQ(is[i], should[i]) << std::hex << "first difference: result " << i / from.a.size() << " of 0x"
                                << bits(from.a[pair]) << " and 0x" << bits(from.b[pair]);
  }
}

TEST(CompilerFlags, optimization_does_not_change_a_bit) {
  const Operands operands;
  expect_same(results(numeric_kernel_o3, operands), results(numeric_kernel_o0, operands), operands);
}

TEST(CompilerFlags, the_instruction_set_does_not_change_a_bit) {
  const Operands operands;
  expect_same(results(numeric_kernel_o3_native, operands), results(numeric_kernel_o0, operands), operands);
}

}  // namespace
}  // namespace ctu::numeric
