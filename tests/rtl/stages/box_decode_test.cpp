// rtl/box_decode.sv against accel::decode_plane, bit for bit: 24 planes at a time.
#include <gtest/gtest.h>
#include <verilated.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "VBoxDecode12.h"
#include "VBoxDecode16.h"
#include "VBoxDecode8.h"
#include "VMutantDecodeNormalOnly.h"
#include "VMutantDecodeToNearest.h"
#include "VMutantDecodeUnlimited.h"
#include "model/accel/quantize.h"
#include "tests/numeric/operands.h"
#include "tests/oracle/seed.h"

namespace ctu::rtl {
namespace {

constexpr std::uint64_t kPlanes = 24;

/// One node for the decoder.
struct Node {
  accel::BoxFrame frame;
  accel::QuantizedBoxes boxes;
  accel::ChildRef child[intersect::kLanes];
};

/// Origins of all classes of numbers, NaN and infinities included; exponents and steps where sums cancel, are exact,
/// overflow or stay subnormal.
class Nodes {
 public:
  Nodes(std::uint64_t seed, std::uint32_t bits)
      : random_(seed), most_((1u << bits) - 1), corners_(numeric::corner_operands()) {}

  Node next() {
    Node node;
    for (int axis = 0; axis < 3; ++axis) {
      node.frame.origin[axis] = origin();
      node.frame.set_exponent(axis, exponent(node.frame.origin[axis]));
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        node.boxes.lo[axis][lane] = steps();
        node.boxes.hi[axis][lane] = steps();
      }
    }
    for (accel::ChildRef& child : node.child) child = below(16) == 0 ? accel::kEmptyChild : below(1u << 31);
    return node;
  }

 private:
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  float origin() {
    if (below(4) == 0) return corners_[random_() % corners_.size()];
    return numeric::from_bits(static_cast<std::uint32_t>(random_()));
  }
  /// Any, or one whose steps are near the origin's last places.
  std::uint32_t exponent(float origin) {
    if (below(3) == 0) return below(accel::kMaxStepExponent + 1);
    const std::uint32_t of_origin = numeric::bits(origin) >> 23 & 255u;  // a unit in the last place has exponent - 1
    const int exponent = static_cast<int>(of_origin) - 1 + static_cast<int>(below(48)) - 24;
    return static_cast<std::uint32_t>(std::clamp(exponent, 0, static_cast<int>(accel::kMaxStepExponent)));
  }
  std::uint16_t steps() {
    switch (below(4)) {
      case 0:
        return static_cast<std::uint16_t>(below(3));
      case 1:
        return static_cast<std::uint16_t>(most_ - below(2));
      case 2:
        return static_cast<std::uint16_t>(std::min(most_, 1u << below(16)));
      default:
        return static_cast<std::uint16_t>(below(most_ + 1));
    }
  }

  std::mt19937_64 random_;
  std::uint32_t most_;
  std::vector<float> corners_;
};

template <class Model>
void drive(Model& model, const Node& node, std::uint32_t bits) {
  for (int axis = 0; axis < 3; ++axis) model.origin_i[axis] = numeric::bits(node.frame.origin[axis]);
  model.exponents_i = node.frame.exponents;
  model.empty_i = 0;
  auto* const words = reinterpret_cast<std::uint32_t*>(&model.planes_i);
  std::fill_n(words, kPlanes * bits / 32, 0u);
  for (std::uint32_t place = 0; place < kPlanes; ++place) {
    const auto& side = place < 12 ? node.boxes.lo : node.boxes.hi;
    const std::uint64_t plane = side[place % 12 / 4][place % 4];
    const std::uint32_t at = place * bits;
    const std::uint64_t moved = plane << (at % 32);
    words[at / 32] |= static_cast<std::uint32_t>(moved);
    if (moved >> 32 != 0) words[at / 32 + 1] |= static_cast<std::uint32_t>(moved >> 32);
  }
  for (int lane = 0; lane < intersect::kLanes; ++lane)
    if (node.child[lane] == accel::kEmptyChild) model.empty_i = static_cast<std::uint8_t>(model.empty_i | 1u << lane);
  model.eval();
}

/// The first plane that differs; empty: none of `nodes` nodes.
template <class Model>
std::string difference(std::uint32_t bits, std::uint64_t nodes) {
  VerilatedContext context;
  Model model(&context);
  Nodes maker(oracle::test_seed() + bits, bits);
  for (std::uint64_t i = 0; i < nodes; ++i) {
    const Node node = maker.next();
    drive(model, node, bits);
    const intersect::Box4 wanted = accel::decode_boxes(node.boxes, node.frame, node.child);
    for (std::uint32_t place = 0; place < kPlanes; ++place) {
      const std::uint32_t axis = place % 12 / 4, lane = place % 4;
      const bool upper = place >= 12;
      const std::uint32_t is = model.boxes_o[place],
                          should = numeric::bits((upper ? wanted.hi : wanted.lo)[axis][lane]);
      if (is == should) continue;
      return fmt::format("{} bits, {} plane: 0x{:08x}, not 0x{:08x}: origin 0x{:08x}, exponent {}, {} steps", bits,
                         upper ? "upper" : "lower", is, should, numeric::bits(node.frame.origin[axis]),
                         node.frame.exponent(static_cast<int>(axis)),
                         (upper ? node.boxes.hi : node.boxes.lo)[axis][lane]);
    }
  }
  return "";
}

TEST(BoxDecode, equals_the_model_on_every_class_of_numbers) {
  SCOPED_TRACE(oracle::seed_note());
  // Planes of each number of bits.
  const std::uint64_t planes = std::getenv("CTU_LONG_TESTS") ? 10'000'000 : 600'000;
  EXPECT_EQ(difference<VBoxDecode16>(16, planes / kPlanes), "");
  EXPECT_EQ(difference<VBoxDecode12>(12, planes / kPlanes), "");
  EXPECT_EQ(difference<VBoxDecode8>(8, planes / kPlanes), "");
}

TEST(BoxDecodeMutants, steps_that_are_never_subnormal_are_caught) {
  EXPECT_NE(difference<VMutantDecodeNormalOnly>(8, 2000), "");
}
TEST(BoxDecodeMutants, planes_rounded_to_nearest_are_caught) {
  EXPECT_NE(difference<VMutantDecodeToNearest>(8, 2000), "");
}
TEST(BoxDecodeMutants, planes_beyond_the_largest_number_are_caught) {
  EXPECT_NE(difference<VMutantDecodeUnlimited>(8, 2000), "");
}

}  // namespace
}  // namespace ctu::rtl
