// The bytes of the image: what lies where, that nothing is lost, and that no damage gets past validate().
#include "model/accel/image.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>

#include "model/accel/build.h"
#include "model/accel/partition.h"
#include "model/base/error.h"
#include "tests/accel/bits.h"
#include "tests/accel/meshes.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using accel::Bvh4;
using accel::Image;
using accel::ImageLayout;

Bvh4 tree() {
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed()))
    if (m.name == "soup") return accel::build(m.mesh, {});
  throw std::logic_error("no soup");
}
const Bvh4& soup() {
  static const Bvh4 bvh = tree();
  return bvh;
}

std::vector<std::uint64_t> random_masks(std::size_t words) {
  std::mt19937_64 random(oracle::test_seed());
  std::vector<std::uint64_t> masks(words);
  for (std::uint64_t& word : masks) word = random();
  return masks;
}

/// Bytes p[0..3] read as the format says, independent of the code under test.
std::uint32_t word_at(const Image& image, std::uint64_t address) {
  std::uint32_t word = 0;
  for (int i = 3; i >= 0; --i) word = word << 8 | image.bytes.at(address + static_cast<std::uint64_t>(i));
  return word;
}
void set_word(Image& image, std::uint64_t address, std::uint32_t word) {
  for (int i = 0; i < 4; ++i)
    image.bytes.at(address + static_cast<std::uint64_t>(i)) = static_cast<std::uint8_t>(word >> (8 * i));
}

Image image_with_masks(std::uint32_t bits, const std::vector<std::uint64_t>& masks) {
  return accel::make_image(soup(), masks.data(), static_cast<int>((bits + 63) / 64), {.mask_bits = bits});
}

TEST(Image, has_the_strides_of_the_papers_figure_6) {
  const auto masks = random_masks(soup().nodes.size() * 4 * 4);
  EXPECT_EQ(accel::make_image(soup(), nullptr, 0, {}).node_stride_bytes, 112u);
  EXPECT_EQ(image_with_masks(8, masks).node_stride_bytes, 116u);
  EXPECT_EQ(image_with_masks(64, masks).node_stride_bytes, 144u);
  EXPECT_EQ(image_with_masks(216, masks).node_stride_bytes, 220u);
  EXPECT_EQ(image_with_masks(27, masks).node_stride_bytes, 128u);
  EXPECT_EQ(accel::make_image(soup(), nullptr, 0, {}).triangle_stride_bytes, 40u);
}

TEST(Image, rounds_strides_and_addresses_up_to_the_alignment) {
  const Image image =
      accel::make_image(soup(), nullptr, 0, {.node_alignment_bytes = 64, .triangle_alignment_bytes = 16});
  EXPECT_EQ(image.node_stride_bytes, 128u);
  EXPECT_EQ(image.triangle_stride_bytes, 48u);
  EXPECT_EQ(image.node_base, 0u);
  EXPECT_EQ(image.triangle_base, image.node_count * 128u);
  EXPECT_EQ(image.node_address(3), 3u * 128);
  EXPECT_EQ(image.triangle_address(3), image.triangle_base + 3 * 48);
  EXPECT_EQ(accel::make_image(soup(), nullptr, 0, {}).triangle_base % 64, 0u);
  EXPECT_EQ(accel::make_image(soup(), nullptr, 0, {.triangle_alignment_bytes = 256}).triangle_base % 256, 0u);
}

TEST(Image, places_every_field_where_the_table_says) {
  const auto masks = random_masks(soup().nodes.size() * 4);
  const Image image = image_with_masks(64, masks);
  for (std::uint32_t n = 0; n < image.node_count; ++n) {
    const accel::Node4& node = soup().nodes[n];
    const std::uint64_t at = n * std::uint64_t{144};
    for (unsigned lane = 0; lane < 4; ++lane) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(word_at(image, at + 16 * axis + 4 * lane), std::bit_cast<std::uint32_t>(node.boxes.lo[axis][lane]));
        ASSERT_EQ(word_at(image, at + 48 + 16 * axis + 4 * lane),
                  std::bit_cast<std::uint32_t>(node.boxes.hi[axis][lane]));
      }
      ASSERT_EQ(word_at(image, at + 96 + 4 * lane), node.child[lane]);
      ASSERT_EQ(word_at(image, at + 112 + 8 * lane), static_cast<std::uint32_t>(masks[4 * n + lane]));
      ASSERT_EQ(word_at(image, at + 116 + 8 * lane), static_cast<std::uint32_t>(masks[4 * n + lane] >> 32));
    }
  }
  for (std::uint32_t t = 0; t < image.triangle_count; ++t) {
    const accel::LeafTriangle& triangle = soup().triangles[t];
    const std::uint64_t at = image.triangle_base + t * std::uint64_t{40};
    const Vec3 v[3] = {triangle.v0, triangle.v1, triangle.v2};
    for (int i = 0; i < 9; ++i)
      ASSERT_EQ(word_at(image, at + 4 * static_cast<unsigned>(i)), std::bit_cast<std::uint32_t>(v[i / 3][i % 3]));
    ASSERT_EQ(word_at(image, at + 36), triangle.primitive);
  }
}

TEST(Image, gives_back_the_tree_it_was_made_of) {
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed())) {
    SCOPED_TRACE(m.name);
    const Bvh4 bvh = accel::build(m.mesh, {});
    const Image image = accel::make_image(bvh, nullptr, 0, {.node_alignment_bytes = 128});
    EXPECT_NO_THROW(accel::validate(image));
    const Bvh4 back = accel::decode(image);
    ASSERT_EQ(back.nodes.size(), bvh.nodes.size());
    for (std::size_t n = 0; n < bvh.nodes.size(); ++n) ASSERT_TRUE(test::same_node(back.nodes[n], bvh.nodes[n])) << n;
    EXPECT_TRUE(test::same_triangles(back.triangles, bvh.triangles));
    EXPECT_EQ(back.depth, bvh.depth);
    EXPECT_EQ(back.lower, bvh.lower);
    EXPECT_EQ(back.upper, bvh.upper);
    EXPECT_EQ(accel::make_image(back, nullptr, 0, image.layout).bytes, image.bytes);
  }
}

TEST(Image, gives_back_every_mask_and_drops_bits_beyond_it) {
  for (const std::uint32_t bits : {1u, 8u, 27u, 64u, 125u, 216u, 512u}) {
    SCOPED_TRACE(bits);
    const std::size_t words = (bits + 63) / 64;
    const auto masks = random_masks(soup().nodes.size() * 4 * words);
    const Image image = image_with_masks(bits, masks);
    EXPECT_NO_THROW(accel::validate(image));
    std::vector<std::uint64_t> mask(words);
    for (std::uint32_t n = 0; n < image.node_count; ++n) {
      for (int lane = 0; lane < 4; ++lane) {
        accel::read_mask(image, n, lane, mask.data());
        for (std::uint32_t bit = 0; bit < 64 * words; ++bit) {
          const std::uint64_t given = masks[(4 * n + static_cast<unsigned>(lane)) * words + bit / 64] >> (bit % 64) & 1;
          ASSERT_EQ(mask[bit / 64] >> (bit % 64) & 1, bit < bits ? given : 0u);
        }
      }
    }
  }
}

TEST(Image, refuses_a_layout_that_is_none) {
  for (const std::uint32_t bad : {0u, 2u, 12u, 8192u}) {
    EXPECT_THROW(accel::make_image(soup(), nullptr, 0, {.node_alignment_bytes = bad}), Error);
    EXPECT_THROW(accel::make_image(soup(), nullptr, 0, {.triangle_alignment_bytes = bad}), Error);
  }
  EXPECT_THROW(accel::make_image(soup(), nullptr, 0, {.mask_bits = 64}), Error);
  const auto masks = random_masks(soup().nodes.size() * 4);
  EXPECT_THROW(accel::make_image(soup(), masks.data(), 1, {.mask_bits = 65}), Error);
}

TEST(Image, refuses_to_read_outside_itself) {
  const Image image = accel::make_image(soup(), nullptr, 0, {});
  EXPECT_THROW(accel::read_node(image, image.node_count), Error);
  EXPECT_THROW(accel::read_triangle(image, image.triangle_count), Error);
}

/// Validates a copy of a good image after `damage`.
template <class Damage>
void expect_caught(const char* what, Damage&& damage) {
  Image image = accel::make_image(soup(), nullptr, 0, {});
  ASSERT_NO_THROW(accel::validate(image));
  damage(image);
  EXPECT_THROW(accel::validate(image), Error) << what;
}

constexpr std::uint64_t kChild = 96;

TEST(Validate, catches_references_that_lead_astray) {
  expect_caught("a child beyond the last node", [](Image& i) { set_word(i, kChild, i.node_count); });
  expect_caught("a node that is its own child", [](Image& i) { set_word(i, i.node_address(1) + kChild, 1); });
  expect_caught("a node that is its parent's parent", [](Image& i) { set_word(i, i.node_address(1) + kChild, 0); });
  expect_caught("two parents", [](Image& i) { set_word(i, kChild + 4, word_at(i, kChild)); });
  expect_caught("a leaf beyond the last triangle",
                [](Image& i) { set_word(i, kChild, accel::make_leaf(i.triangle_count, 1)); });
  expect_caught("a leaf across the last triangle",
                [](Image& i) { set_word(i, kChild, accel::make_leaf(i.triangle_count - 1, 2)); });
  expect_caught("a triangle in two leaves", [](Image& i) { set_word(i, kChild, accel::make_leaf(0, 1)); });
  expect_caught("a hole before a child", [](Image& i) { set_word(i, kChild, accel::kEmptyChild); });
}

/// The soup with every node of an odd number bare.
struct Stripped {
  Bvh4 bvh = soup();
  accel::Partition partition;
  std::vector<std::uint64_t> masks = random_masks(soup().nodes.size() * 4);
  Stripped() {
    std::vector<bool> carries(bvh.nodes.size());
    for (std::size_t n = 0; n < carries.size(); ++n) carries[n] = n % 2 == 0;
    partition = accel::partition_nodes(bvh, carries);
  }
  Image image(std::uint32_t alignment) const {
    return accel::make_image(bvh, masks.data(), 1,
                             {.mask_bits = 64, .node_alignment_bytes = alignment, .bare_nodes = partition.bare_nodes});
  }
};

TEST(BareNodes, are_the_same_tree_in_another_order) {
  const Stripped stripped;
  EXPECT_EQ(stripped.partition.bare_nodes, soup().nodes.size() / 2);
  EXPECT_EQ(stripped.partition.old_index.front(), 0u);
  for (std::size_t n = 0; n < stripped.bvh.nodes.size(); ++n) {
    const accel::Node4& old = soup().nodes[stripped.partition.old_index[n]];
    for (int lane = 0; lane < 4; ++lane) {
      const accel::ChildRef child = stripped.bvh.nodes[n].child[lane];
      ASSERT_EQ(accel::is_inner(child) ? stripped.partition.old_index[child] : child, old.child[lane]);
    }
    ASSERT_EQ(std::memcmp(&stripped.bvh.nodes[n].boxes, &old.boxes, sizeof old.boxes), 0);
  }
}

TEST(BareNodes, take_no_bytes_for_masks_and_are_read_back) {
  const Stripped stripped;
  for (const std::uint32_t alignment : {4u, 128u}) {
    const Image image = stripped.image(alignment);
    EXPECT_NO_THROW(accel::validate(image));
    EXPECT_EQ(image.node_stride_bytes, alignment == 4 ? 144u : 256u);
    EXPECT_EQ(image.bare_node_stride_bytes, alignment == 4 ? 112u : 128u);
    EXPECT_EQ(image.node_address(image.node_count),
              image.masked_nodes() * std::uint64_t{image.node_stride_bytes} +
                  stripped.partition.bare_nodes * std::uint64_t{image.bare_node_stride_bytes});
    const Bvh4 back = accel::decode(image);
    for (std::size_t n = 0; n < back.nodes.size(); ++n)
      ASSERT_TRUE(test::same_node(back.nodes[n], stripped.bvh.nodes[n])) << n;
    std::uint64_t mask = 0;
    accel::read_mask(image, image.masked_nodes() - 1, 3, &mask);
    EXPECT_EQ(mask, stripped.masks[4 * image.masked_nodes() - 1]);
    EXPECT_THROW(accel::read_mask(image, image.masked_nodes(), 0, &mask), Error);
  }
}

TEST(BareNodes, cannot_be_all_nodes_or_lie_in_an_image_without_masks) {
  const auto masks = random_masks(soup().nodes.size() * 4);
  const auto all = static_cast<std::uint32_t>(soup().nodes.size());
  EXPECT_THROW(accel::make_image(soup(), masks.data(), 1, {.mask_bits = 64, .bare_nodes = all}), Error);
  EXPECT_THROW(accel::make_image(soup(), nullptr, 0, {.bare_nodes = 1}), Error);
  Image image = Stripped().image(4);
  image.layout.bare_nodes = image.node_count;
  EXPECT_THROW(accel::validate(image), Error);
}

TEST(BareNodes, lets_no_damaged_child_word_past) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  const Image good = Stripped().image(4);
  for (int i = 0; i < 300; ++i) {
    Image image = good;
    const std::uint64_t at =
        image.node_address(static_cast<std::uint32_t>(random() % image.node_count)) + kChild + 4 * (random() % 4);
    const auto word = static_cast<std::uint32_t>(random() % 2 == 0 ? random() : random() % image.node_count);
    if (word_at(image, at) == word) continue;
    set_word(image, at, word);
    EXPECT_THROW(accel::validate(image), Error) << "address " << at << " word " << word;
  }
}

TEST(Validate, catches_sizes_that_do_not_fit) {
  expect_caught("bytes missing", [](Image& i) { i.bytes.pop_back(); });
  expect_caught("bytes too many", [](Image& i) { i.bytes.push_back(0); });
  expect_caught("one node more", [](Image& i) { ++i.node_count; });
  expect_caught("no nodes", [](Image& i) { i.node_count = 0; });
  expect_caught("one triangle less", [](Image& i) { --i.triangle_count; });
  expect_caught("another stride", [](Image& i) { i.node_stride_bytes = 108; });
  expect_caught("another base", [](Image& i) { i.triangle_base -= 4; });
  expect_caught("masks that are not there", [](Image& i) { i.layout.mask_bits = 64; });
  expect_caught("a depth too small", [](Image& i) { --i.depth; });
  expect_caught("a depth too large", [](Image& i) { ++i.depth; });
}

TEST(Validate, catches_numbers_that_are_none) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity}) {
    const auto bits = std::bit_cast<std::uint32_t>(bad);
    expect_caught("a box", [&](Image& i) { set_word(i, 0, bits); });
    expect_caught("a vertex", [&](Image& i) { set_word(i, i.triangle_base + 8, bits); });
    expect_caught("the bounds", [&](Image& i) { i.lower.y = bad; });
  }
  expect_caught("a box turned inside out", [](Image& i) { set_word(i, 48, std::bit_cast<std::uint32_t>(-1e9f)); });
  expect_caught("an id that means none", [](Image& i) { set_word(i, i.triangle_base + 36, intersect::kNoPrimitive); });
}

TEST(Validate, lets_no_damaged_child_word_past_unless_it_is_a_tree) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  const Image good = accel::make_image(soup(), nullptr, 0, {});
  for (int i = 0; i < 300; ++i) {
    Image image = good;
    const std::uint64_t at =
        image.node_address(static_cast<std::uint32_t>(random() % image.node_count)) + kChild + 4 * (random() % 4);
    const auto word = static_cast<std::uint32_t>(random() % 2 == 0 ? random() : random() % image.node_count);
    if (word_at(image, at) == word) continue;
    set_word(image, at, word);
    // Any other word loses what the old one led to, so the whole can no longer be reached exactly once.
    EXPECT_THROW(accel::validate(image), Error) << "address " << at << " word " << word;
  }
}

}  // namespace
