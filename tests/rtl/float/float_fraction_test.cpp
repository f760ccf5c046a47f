// rtl/float/float_fraction.sv against the products of cull::lerp_planes, for every plane of every resolution.
#include <gtest/gtest.h>
#include <verilated.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "VFloatFraction.h"
#include "model/cull/plane_times.h"
#include "tests/numeric/operands.h"
#include "tests/oracle/seed.h"

namespace ctu::rtl {
namespace {

using numeric::bits;
using numeric::from_bits;
using numeric::Round;

/// The weight k / n that moves the product outwards.
template <Round M>
float weight(int k, int n, float a) {
  const cull::LerpWeights& weights = cull::lerp_weights(n);
  const auto& outward = (a < 0) == (M == Round::Down) ? weights.second_up : weights.second_down;
  return outward[(k - 1) / 4][(k - 1) % 4];
}

template <Round M>
void expect_same(std::uint32_t is, int k, int n, float a) {
  const std::uint32_t should = bits(numeric::mul<M>(weight<M>(k, n, a), a));
  ASSERT_EQ(is, should) << std::hex << "0x" << is << ", not 0x" << should << ": 0x" << bits(a) << std::dec << " * " << k
                        << " / " << n << ", rounded " << (M == Round::Down ? "down" : "up");
}

/// One, whose products are the weights themselves; every class of number; any bits, one in four of them where products
/// become subnormal, one in four of few places.
std::vector<float> operands(std::uint64_t seed, int random_ones) {
  std::vector<float> list = numeric::corner_operands();
  std::mt19937_64 random(seed);
  for (int i = 0; i < random_ones; ++i) {
    auto word = static_cast<std::uint32_t>(random());
    if (i % 4 == 1) word = (word & 0x807fffffu) | static_cast<std::uint32_t>(random() % 9) << 23;
    if (i % 4 == 2) word &= ~0u << (random() % 24);
    list.push_back(from_bits(word));
  }
  return list;
}

TEST(FloatFraction, gives_the_product_with_the_outward_weight_for_every_plane_of_every_resolution) {
  SCOPED_TRACE(oracle::seed_note());
  VerilatedContext context;
  VFloatFraction bench(&context);
  for (const float a : operands(oracle::test_seed(), std::getenv("CTU_LONG_TESTS") ? 200'000 : 20'000)) {
    bench.a_i = bits(a);
    bench.eval();
    for (int n = cull::kMinResolution; n <= cull::kMaxRayResolution; ++n) {
      for (int k = 1; k < n; ++k) {
        const int place = (n - 1) * (n - 2) / 2 + k - 1;
        expect_same<Round::Down>(bench.down_o[place], k, n, a);
        expect_same<Round::Up>(bench.up_o[place], k, n, a);
        if (HasFatalFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace ctu::rtl
