// Boxes of reduced precision: the decoder against exact arithmetic, the encoder's promise that no box loses anything,
// and the bytes.
#include "model/accel/quantize.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/accel/image.h"
#include "model/base/error.h"
#include "tests/accel/bits.h"
#include "tests/accel/meshes.h"
#include "tests/oracle/exact_round.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using accel::Node4;
using accel::QuantizedBoxes;

constexpr std::uint32_t kBits[] = {16, 12, 8};
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Coordinates and nodes of the kinds that break encoders.
class NodeMaker {
 public:
  explicit NodeMaker(std::uint64_t seed) : random_(seed) {}

  /// Any finite number, all exponents alike.
  float any_finite() {
    for (;;)
      if (const float x = numeric::from_bits(static_cast<std::uint32_t>(random_())); std::isfinite(x)) return x;
  }
  float uniform(float from, float to) { return from + (to - from) * static_cast<float>(random_() >> 40) * 0x1p-24f; }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

  /// One to four boxes of a kind that changes from node to node.
  Node4 node() {
    Node4 node;
    const std::uint32_t lanes = 1 + below(4);
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t kind = below(8);
      const float offset = std::ldexp(uniform(-1, 1), static_cast<int>(below(60)) - 30);
      const float size = std::ldexp(uniform(0, 1), static_cast<int>(below(80)) - 50);
      for (std::uint32_t lane = 0; lane < intersect::kLanes; ++lane) {
        float a = coordinate(kind, offset, size), b = coordinate(kind, offset, size);
        if (below(8) == 0) b = a;  // flat
        const bool there = lane < lanes;
        node.boxes.lo[axis][lane] = there ? std::min(a, b) : kInfinity;
        node.boxes.hi[axis][lane] = there ? std::max(a, b) : -kInfinity;
        node.child[lane] = there ? accel::make_leaf(lane, 1) : accel::kEmptyChild;
      }
    }
    return node;
  }

 private:
  float coordinate(std::uint32_t kind, float offset, float size) {
    switch (kind) {
      case 0:
        return any_finite();
      case 1:  // huge
        return uniform(-1, 1) * kLargest;
      case 2:  // subnormal
        return numeric::from_bits(below(1u << 23) | (below(2) << 31));
      case 3:  // a few neighbours on the binary32 line
        return numeric::from_bits(numeric::bits(offset) + below(4));
      case 4:  // on a lattice: planes coincide, and lie on steps
        return static_cast<float>(below(257));
      case 5:
        return below(2) == 0 ? kLargest : -uniform(0, 1);
      case 6:  // all in one plane
        return offset;
      default:
        return offset + uniform(0, 1) * size;
    }
  }
  std::mt19937_64 random_;
};

std::string text(const Node4& node) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text +=
        fmt::format("\n  axis {}, origin {:a}, exponent {}:", axis, node.frame.origin[axis], node.frame.exponent(axis));
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      text += fmt::format(" [{:a}, {:a}]", node.boxes.lo[axis][lane], node.boxes.hi[axis][lane]);
  }
  return text;
}

/// The node with the boxes of the frame that the encoder gives it.
Node4 quantized(const Node4& node, std::uint32_t bits, QuantizedBoxes& boxes) {
  Node4 result = node;
  result.frame = accel::box_frame(node, bits);
  boxes = accel::quantize(result, bits);
  result.boxes = accel::decode_boxes(boxes, result.frame, result.child);
  return result;
}

TEST(BoxDecoder, gives_the_exact_plane_rounded_once_in_its_direction) {
  SCOPED_TRACE(oracle::seed_note());
  NodeMaker make(oracle::test_seed());
  for (int i = 0; i < 150000; ++i) {
    const float origin = i % 7 == 0 ? 0.0f : make.any_finite();
    const std::uint32_t exponent = make.below(accel::kMaxStepExponent + 1);
    const std::uint32_t q = i % 5 == 0 ? make.below(4) : make.below(1u << 16);
    const double offset = std::ldexp(static_cast<double>(q), static_cast<int>(exponent) - 149);
    const auto told = [&](numeric::Round round) {
      if (offset > static_cast<double>(kLargest)) return kLargest;
      return std::min(oracle::exact_operation(oracle::Operation::Add, round, origin, static_cast<float>(offset)),
                      kLargest);
    };
    ASSERT_EQ(static_cast<double>(accel::step_of(exponent)), std::ldexp(1.0, static_cast<int>(exponent) - 149));
    ASSERT_EQ(numeric::bits(accel::decode_lower(origin, exponent, q)), numeric::bits(told(numeric::Round::Down)))
        << fmt::format("{:a} + {} steps of exponent {}", origin, q, exponent);
    ASSERT_EQ(numeric::bits(accel::decode_upper(origin, exponent, q)), numeric::bits(told(numeric::Round::Up)))
        << fmt::format("{:a} + {} steps of exponent {}", origin, q, exponent);
  }
}

TEST(BoxDecoder, planes_never_move_down_as_the_number_grows) {
  SCOPED_TRACE(oracle::seed_note());
  NodeMaker make(oracle::test_seed() + 1);
  for (int i = 0; i < 200; ++i) {
    const float origin = make.any_finite();
    const std::uint32_t exponent = make.below(accel::kMaxStepExponent + 1);
    for (std::uint32_t q = 0; q < 4096; ++q) {
      ASSERT_LE(accel::decode_lower(origin, exponent, q), accel::decode_lower(origin, exponent, q + 1));
      ASSERT_LE(accel::decode_upper(origin, exponent, q), accel::decode_upper(origin, exponent, q + 1));
    }
  }
}

/// Containment, and that no plane could be nearer.
void expect_tight(const Node4& node, const Node4& decoded, const QuantizedBoxes& boxes, std::uint32_t bits) {
  const std::uint32_t most = (1u << bits) - 1;
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = decoded.frame.origin[axis];
    const std::uint32_t exponent = decoded.frame.exponent(axis);
    ASSERT_LE(exponent, accel::kMaxStepExponent);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const float lo = node.boxes.lo[axis][lane], hi = node.boxes.hi[axis][lane];
      const std::uint32_t below = boxes.lo[axis][lane], above = boxes.hi[axis][lane];
      if (node.child[lane] == accel::kEmptyChild) {
        ASSERT_EQ(below + above, 0u);
        ASSERT_EQ(decoded.boxes.lo[axis][lane], kInfinity);
        ASSERT_EQ(decoded.boxes.hi[axis][lane], -kInfinity);
        continue;
      }
      ASSERT_LE(decoded.boxes.lo[axis][lane], lo) << "axis " << axis << ", lane " << lane;
      ASSERT_GE(decoded.boxes.hi[axis][lane], hi) << "axis " << axis << ", lane " << lane;
      ASSERT_TRUE(std::isfinite(decoded.boxes.lo[axis][lane]) && std::isfinite(decoded.boxes.hi[axis][lane]));
      // The next number is beyond the plane, or says the same; infinite offsets serve upper planes only.
      const bool finite = std::isfinite(static_cast<float>(below + 1) * accel::step_of(exponent));
      if (below < most && finite) {
        const float next = accel::decode_lower(origin, exponent, below + 1);
        ASSERT_TRUE(next > lo || next == decoded.boxes.lo[axis][lane]) << "axis " << axis << ", lane " << lane;
      }
      if (above > 0) {
        const float next = accel::decode_upper(origin, exponent, above - 1);
        ASSERT_TRUE(next < hi || next == decoded.boxes.hi[axis][lane]) << "axis " << axis << ", lane " << lane;
      }
    }
  }
}

TEST(BoxEncoder, holds_every_box_as_tightly_as_the_frame_allows) {
  SCOPED_TRACE(oracle::seed_note());
  for (const std::uint32_t bits : kBits) {
    NodeMaker make(oracle::test_seed() + bits);
    for (int i = 0; i < 150000; ++i) {  // about a million boxes in all
      const Node4 node = make.node();
      QuantizedBoxes boxes;
      const Node4 decoded = quantized(node, bits, boxes);
      expect_tight(node, decoded, boxes, bits);
      if (testing::Test::HasFatalFailure()) FAIL() << bits << " bits, node " << i << text(node) << text(decoded);
    }
  }
}

TEST(BoxEncoder, chooses_the_smallest_step_that_reaches_the_upper_corner) {
  SCOPED_TRACE(oracle::seed_note());
  for (const std::uint32_t bits : kBits) {
    const double most = static_cast<double>((1u << bits) - 1);
    NodeMaker make(oracle::test_seed() + 10 + bits);
    for (int i = 0; i < 50000; ++i) {
      const Node4 node = make.node();
      const accel::BoxFrame frame = accel::box_frame(node, bits);
      for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t exponent = frame.exponent(axis);
        const float* const lo = node.boxes.lo[axis];
        const float* const hi = node.boxes.hi[axis];
        const float lower = std::min({lo[0], lo[1], lo[2], lo[3]}), upper = std::max({hi[0], hi[1], hi[2], hi[3]});
        ASSERT_EQ(frame.origin[axis], lower);
        ASSERT_GE(accel::decode_upper(lower, exponent, (1u << bits) - 1), upper) << text(node);
        if (exponent == 0) continue;
        const double half = static_cast<double>(accel::step_of(exponent - 1)) * most;
        ASSERT_TRUE(half < static_cast<double>(upper) - static_cast<double>(lower) ||
                    accel::decode_upper(lower, exponent - 1, (1u << bits) - 1) < upper)
            << text(node);
      }
    }
  }
}

TEST(BoxEncoder, leaves_boxes_that_its_frame_says_as_they_are) {
  SCOPED_TRACE(oracle::seed_note());
  for (const std::uint32_t bits : kBits) {
    NodeMaker make(oracle::test_seed() + 20 + bits);
    for (int i = 0; i < 50000; ++i) {
      QuantizedBoxes boxes;
      const Node4 decoded = quantized(make.node(), bits, boxes);
      const intersect::Box4 again = accel::decode_boxes(accel::quantize(decoded, bits), decoded.frame, decoded.child);
      ASSERT_TRUE(test::same_bits(again, decoded.boxes)) << bits << " bits" << text(decoded);
    }
  }
}

TEST(BoxEncoder, is_exact_for_boxes_on_few_steps) {
  Node4 node;
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      node.boxes.lo[axis][lane] = static_cast<float>(100 + 10 * lane);
      node.boxes.hi[axis][lane] = static_cast<float>(100 + 10 * lane + axis);
      node.child[lane] = accel::make_leaf(static_cast<std::uint32_t>(lane), 1);
    }
  for (const std::uint32_t bits : kBits) {
    QuantizedBoxes boxes;
    const Node4 decoded = quantized(node, bits, boxes);
    EXPECT_TRUE(test::same_bits(decoded.boxes, node.boxes));
    EXPECT_EQ(boxes.lo[0][0], 0u);
  }
}

accel::Bvh4 tree_of(const std::string& name, std::uint32_t bits) {
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed())) {
    if (m.name != name) continue;
    accel::Bvh4 bvh = accel::build(m.mesh, {});
    if (bits != accel::kFullBoxBits) accel::quantize_boxes(bvh, bits, 2);
    return bvh;
  }
  throw std::logic_error("no " + name);
}

std::uint32_t word_at(const accel::Image& image, std::uint64_t address) {
  std::uint32_t word = 0;
  for (int i = 3; i >= 0; --i) word = word << 8 | image.bytes.at(address + static_cast<std::uint64_t>(i));
  return word;
}

/// The number as the format says, bit by bit.
std::uint32_t number_at(const accel::Image& image, std::uint64_t row, std::uint32_t bits, std::uint32_t place) {
  std::uint32_t number = 0;
  for (std::uint32_t i = 0; i < bits; ++i) {
    const std::uint32_t bit = place * bits + i;
    number |= (image.bytes.at(row + bit / 8) >> (bit % 8) & 1u) << i;
  }
  return number;
}

TEST(CompactImage, has_the_strides_of_its_table) {
  const std::uint32_t strides[3][4] = {{80, 84, 112, 188}, {68, 72, 100, 176}, {56, 60, 88, 164}};
  for (int i = 0; i < 3; ++i) {
    const accel::Bvh4 bvh = tree_of("soup", kBits[i]);
    const std::vector<std::uint64_t> masks(bvh.nodes.size() * 16);
    const std::uint32_t mask_bits[] = {0, 8, 64, 216};
    for (int m = 0; m < 4; ++m) {
      const accel::Image image =
          accel::make_image(bvh, masks.data(), 4, {.mask_bits = mask_bits[m], .box_bits = kBits[i]});
      EXPECT_EQ(image.node_stride_bytes, strides[i][m]);
    }
    EXPECT_EQ(accel::make_image(bvh, nullptr, 0, {.node_alignment_bytes = 64, .box_bits = kBits[i]}).node_stride_bytes,
              kBits[i] == 8 ? 64u : 128u);
  }
}

TEST(CompactImage, places_every_field_where_the_table_says) {
  std::mt19937_64 random(oracle::test_seed());
  for (const std::uint32_t bits : kBits) {
    const accel::Bvh4 bvh = tree_of("soup", bits);
    std::vector<std::uint64_t> masks(bvh.nodes.size() * 4);
    for (std::uint64_t& mask : masks) mask = random();
    const accel::Image image = accel::make_image(bvh, masks.data(), 1, {.mask_bits = 64, .box_bits = bits});
    for (std::uint32_t n = 0; n < image.node_count; ++n) {
      const Node4& node = bvh.nodes[n];
      const std::uint64_t at = image.node_address(n);
      for (unsigned axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(word_at(image, at + 4 * axis), std::bit_cast<std::uint32_t>(node.frame.origin[axis]));
        const std::uint32_t exponent = word_at(image, at + 12) >> (10 * axis) & 1023;
        for (unsigned lane = 0; lane < 4; ++lane) {
          if (node.child[lane] == accel::kEmptyChild) continue;
          const std::uint32_t lo = number_at(image, at + 32, bits, 4 * axis + lane),
                              hi = number_at(image, at + 32, bits, 12 + 4 * axis + lane);
          ASSERT_EQ(accel::decode_lower(node.frame.origin[axis], exponent, lo), node.boxes.lo[axis][lane]);
          ASSERT_EQ(accel::decode_upper(node.frame.origin[axis], exponent, hi), node.boxes.hi[axis][lane]);
        }
      }
      for (unsigned lane = 0; lane < 4; ++lane) {
        ASSERT_EQ(word_at(image, at + 16 + 4 * lane), node.child[lane]);
        ASSERT_EQ(word_at(image, at + 32 + 3 * bits + 8 * lane), static_cast<std::uint32_t>(masks[4 * n + lane]));
      }
    }
  }
}

TEST(CompactImage, gives_back_the_tree_it_was_made_of) {
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed()))
    for (const std::uint32_t bits : kBits) {
      SCOPED_TRACE(m.name + ", " + std::to_string(bits) + " bits");
      accel::Bvh4 bvh = accel::build(m.mesh, {});
      accel::quantize_boxes(bvh, bits, 1);
      const accel::Image image = accel::make_image(bvh, nullptr, 0, {.box_bits = bits});
      EXPECT_NO_THROW(accel::validate(image));
      const accel::Bvh4 back = accel::decode(image);
      ASSERT_EQ(back.nodes.size(), bvh.nodes.size());
      for (std::size_t n = 0; n < bvh.nodes.size(); ++n) ASSERT_TRUE(test::same_node(back.nodes[n], bvh.nodes[n])) << n;
      EXPECT_EQ(accel::make_image(back, nullptr, 0, {.box_bits = bits}).bytes, image.bytes);
    }
}

TEST(CompactImage, is_refused_with_bits_that_are_none_and_boxes_that_were_not_quantized) {
  EXPECT_THROW(accel::make_image(tree_of("soup", 8), nullptr, 0, {.box_bits = 10}), Error);
  EXPECT_THROW(accel::make_image(tree_of("soup", 32), nullptr, 0, {.box_bits = 8}), Error);
  EXPECT_THROW(accel::make_image(tree_of("soup", 16), nullptr, 0, {.box_bits = 8}), Error);
  accel::Bvh4 bvh = tree_of("soup", 32);
  EXPECT_THROW(accel::quantize_boxes(bvh, 32, 1), Error);
  EXPECT_THROW(accel::quantize_boxes(bvh, 0, 1), Error);
}

TEST(CompactImage, validation_catches_a_damaged_frame) {
  const accel::Image image = accel::make_image(tree_of("soup", 8), nullptr, 0, {.box_bits = 8});
  const auto refused = [&](std::uint64_t address, std::uint32_t word) {
    accel::Image damaged = image;
    for (int i = 0; i < 4; ++i)
      damaged.bytes[address + static_cast<std::uint64_t>(i)] = static_cast<std::uint8_t>(word >> (8 * i));
    EXPECT_THROW(accel::validate(damaged), Error) << address << " " << word;
  };
  const std::uint64_t root = image.node_address(0);
  refused(root, std::bit_cast<std::uint32_t>(kInfinity));
  refused(root + 4, 0x7fc00000u);
  refused(root + 12, word_at(image, root + 12) | 1u << 31);
  refused(root + 12, accel::kMaxStepExponent + 1);
  refused(root + 12, 1023u << 10);
  // A lane's lower planes at the top: its box is turned inside out.
  refused(root + 32, word_at(image, root + 32) | 0xffu);
  for (std::uint32_t n = 0; n < image.node_count; ++n)
    if (accel::read_node(image, n).child[3] == accel::kEmptyChild) {
      refused(image.node_address(n) + 32, word_at(image, image.node_address(n) + 32) | 0x01000000u);
      return;
    }
}

}  // namespace
