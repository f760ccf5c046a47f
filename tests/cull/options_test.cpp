#include "model/cull/options.h"

#include <gtest/gtest.h>

#include "model/base/error.h"

namespace ctu::cull {
namespace {

TEST(Options, every_design_is_found_by_its_name) {
  for (const Design design : {Design::None, Design::Ideal, Design::MaskLut, Design::Projection, Design::Comparators})
    EXPECT_EQ(design_from_string(to_string(design)), design) << to_string(design);
  EXPECT_EQ(to_string(Design::MaskLut), "mask-lut");
  EXPECT_FALSE(design_from_string("masklut").has_value());
  EXPECT_FALSE(design_from_string("").has_value());
}

TEST(Options, projection_shares_the_events_of_the_table_it_equals) {
  EXPECT_EQ(event_class(Design::Projection), Design::MaskLut);
  EXPECT_EQ(event_class(Design::Comparators), Design::Comparators);
}

TEST(Options, masks_take_as_many_words_as_their_bits_need) {
  const int words[] = {1, 1, 1, 2, 4, 6, 8};
  for (int r = kMinResolution; r <= kMaxResolution; ++r) EXPECT_EQ(words_per_mask(r), words[r - 2]) << "R = " << r;
}

TEST(Options, given_a_value_out_of_range_then_the_error_names_it_and_the_range) {
  const MaskOptions bad[] = {{.resolution = 1},      {.resolution = 9}, {.ray_resolution = 1},
                             {.ray_resolution = 17}, {.levels = -1},    {.levels = kMaxLevels + 1}};
  const char* names[] = {"R", "R", "R_ray", "R_ray", "L", "L"};
  for (std::size_t i = 0; i < std::size(bad); ++i) {
    try {
      validate(bad[i]);
      FAIL() << "case " << i << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(error.where().find(names[i]), std::string::npos) << error.what();
      EXPECT_NE(error.remedy().find("from"), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(validate({.resolution = 8, .ray_resolution = 16, .levels = 5}));
}

}  // namespace
}  // namespace ctu::cull
