// What a tailored unit has and what another trace needs: each missing part is refused by its name.
#include "sim/tailor/unit_parts.h"

#include <gtest/gtest.h>

#include <functional>

#include "model/base/error.h"
#include "sim/energy/unit_shape.h"

namespace {

using ctu::Error;
using ctu::energy::UnitShape;
using ctu::tailor::joined;
using ctu::tailor::parts_from;
using ctu::tailor::parts_of;
using ctu::tailor::require_parts;
using ctu::tailor::UnitParts;

/// A unit of triangles in leaves of 160 bytes, whose stacks never spill.
UnitShape plain() {
  UnitShape shape;
  shape.spills = false;
  return shape;
}

std::string refusal(const UnitParts& built, const UnitShape& needed) {
  try {
    require_parts(built, needed, "other.ctut");
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "other.ctut");
    EXPECT_FALSE(error.remedy().empty());
    return error.problem();
  }
  return "";
}

TEST(UnitParts, what_the_unit_was_tailored_to_is_taken) { EXPECT_EQ(refusal(parts_of(plain()), plain()), ""); }

TEST(UnitParts, each_missing_part_is_named) {
  const UnitParts built = parts_of(plain());
  const std::pair<const char*, std::function<void(UnitShape&)>> needs[] = {
      {"sphere_test", [](UnitShape& s) { s.spheres = true; }},
      {"primitive_cull", [](UnitShape& s) { s.primitive_boxes = true; }},
      {"packet_cull",
       [](UnitShape& s) {
         s.packet_rays = 16;
         s.packet_entries = 8;
       }},
      {"a larger table of roots", [](UnitShape& s) { s.trees = 5; }},
      {"box_decode", [](UnitShape& s) { s.box_bits = 16; }},
      {"spills of traversal_stack", [](UnitShape& s) { s.spills = true; }},
      {"a larger leaf buffer", [](UnitShape& s) { s.leaf_bytes = 320; }},
      {"a mask test of R = 6", [](UnitShape& s) { s.resolution = 6; }},
      {"a mask test of R = 4, R_ray = 8", [](UnitShape& s) { s.ray_resolution = 8; }},
      {"compressed to 256 entries", [](UnitShape& s) { s.entries = 256; }}};
  for (const auto& [part, need] : needs) {
    UnitShape other = plain();
    need(other);
    EXPECT_NE(refusal(built, other).find(std::string("needs ") + (part[0] == 'c' ? "a mask test" : part)),
              std::string::npos)
        << part << ": " << refusal(built, other);
  }
}

TEST(UnitParts, rays_alone_and_rays_in_packets_need_units_of_their_own) {
  UnitShape packets = plain(), more = plain();
  packets.packet_rays = more.packet_rays = 16;
  packets.packet_entries = 4;
  more.packet_entries = 9;
  EXPECT_NE(refusal(parts_of(packets), plain()).find("rays that begin alone"), std::string::npos);
  EXPECT_THROW(joined(parts_of(packets), parts_of(plain()), "alone.ctut"), Error);
  EXPECT_NE(refusal(parts_of(packets), more).find("more entries of a packet"), std::string::npos);
  EXPECT_EQ(refusal(joined(parts_of(packets), parts_of(more), "more.ctut"), more), "");
}

TEST(UnitParts, a_unit_without_culling_takes_traces_of_any_masks) {
  UnitShape bare = plain();
  bare.config.mask_test.design = ctu::cull::Design::None;
  UnitShape other = bare;
  other.resolution = 6;
  EXPECT_EQ(refusal(parts_of(bare), other), "");
}

TEST(UnitParts, a_unit_for_two_traces_has_what_either_needs) {
  UnitShape spheres = plain(), leaves = plain();
  spheres.spheres = true;
  leaves.leaf_bytes = 600;
  const UnitParts both = joined(parts_of(spheres), parts_of(leaves), "leaves.ctut");
  EXPECT_EQ(refusal(both, spheres), "");
  EXPECT_EQ(refusal(both, leaves), "");
  UnitShape coarse = plain();
  coarse.box_bits = 8;
  EXPECT_THROW(joined(both, parts_of(coarse), "coarse.ctut"), Error);
}

TEST(UnitParts, come_back_from_what_was_written_and_nothing_else_does) {
  std::map<std::string, ctu::pipeline::ParameterValue> values = {{"spheres", true}, {"leaf_bytes", std::int64_t{320}}};
  EXPECT_TRUE(parts_from(values, "unit.toml").spheres);
  EXPECT_EQ(parts_from(values, "unit.toml").leaf_bytes, 320);
  values["wings"] = true;
  EXPECT_THROW(parts_from(values, "unit.toml"), Error);
  EXPECT_THROW(parts_from({{"spheres", std::int64_t{1}}}, "unit.toml"), Error);
}

}  // namespace
