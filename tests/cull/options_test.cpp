#include "model/cull/options.h"

#include <gtest/gtest.h>

#include "model/base/error.h"

namespace ctu::cull {
namespace {

TEST(Options, every_design_is_found_by_its_name) {
  for (const Design design : {Design::None, Design::Ideal, Design::MaskLut, Design::BitTable, Design::Dedup,
                              Design::Projection, Design::Comparators})
    EXPECT_EQ(design_from_string(to_string(design)), design) << to_string(design);
  EXPECT_EQ(to_string(Design::MaskLut), "mask-lut");
  EXPECT_FALSE(design_from_string("masklut").has_value());
  EXPECT_FALSE(design_from_string("").has_value());
}

TEST(Options, designs_with_the_masks_of_the_table_share_its_events) {
  for (const Design design : {Design::Projection, Design::BitTable, Design::Dedup})
    EXPECT_EQ(event_class(design), Design::MaskLut);
  EXPECT_EQ(event_class(Design::Comparators), Design::Comparators);
}

TEST(Options, masks_take_as_many_words_as_their_bits_need) {
  const int words[] = {1, 1, 1, 2, 4, 6, 8};
  for (int r = kMinResolution; r <= kMaxResolution; ++r) EXPECT_EQ(words_per_mask(r), words[r - 2]) << "R = " << r;
}

TEST(Options, given_a_value_out_of_range_then_the_error_names_it_and_the_range) {
  const MaskOptions bad[] = {{.resolution = 1},
                             {.resolution = 9},
                             {.ray_resolution = 3},
                             {.ray_resolution = 25},
                             {.resolution = 6, .ray_resolution = 5},
                             {.levels = -1},
                             {.levels = kMaxLevels + 1},
                             {.entries = 15},
                             {.entries = 4097}};
  const char* names[] = {"R", "R", "R_ray", "R_ray", "R_ray", "L", "L", "entries", "entries"};
  for (std::size_t i = 0; i < std::size(bad); ++i) {
    try {
      validate(bad[i]);
      FAIL() << "case " << i << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(error.where().find(names[i]), std::string::npos) << error.what();
      EXPECT_NE(error.remedy().find("from"), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(validate({.resolution = 8, .ray_resolution = 24, .levels = 5, .entries = 4096}));
}

TEST(Options, object_masks_alone_have_no_ray_resolution) {
  EXPECT_NO_THROW(validate_object_masks({.resolution = 8, .ray_resolution = 4}));
  EXPECT_THROW(validate_object_masks({.resolution = 9}), Error);
}

}  // namespace
}  // namespace ctu::cull
