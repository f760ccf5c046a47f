#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "model/base/error.h"
#include "model/scene/vector64.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using HairTest = SceneFiles;
using TfxTest = SceneFiles;

const std::vector<std::vector<Vec3>> kTwoStrands = {{{0, 0, 0}, {0, 0, 1}, {0, 1, 2}},
                                                    {{5, 0, 0}, {6, 1, 0}, {7, 1, 0}}};

double distance(const Vec3& a, const Vec3& b) { return length(Vector64(a) - Vector64(b)); }

// Vertices 2i and 2i + 1 are the two edges of the ribbon at point i.
void expect_ribbon(const Mesh& mesh, std::size_t point, const Vec3& center, double width) {
  const Vector64 left(mesh.vertices.at(2 * point)), right(mesh.vertices.at(2 * point + 1));
  EXPECT_LT(length((left + right) * 0.5 - Vector64(center)), 1e-5);
  EXPECT_NEAR(length(right - left), width, 1e-5);
}

TEST_F(HairTest, every_segment_is_two_triangles_of_the_stated_width) {
  const Scene scene = load(write("a.hair", hair_file(kTwoStrands, 0.1f, false)));
  EXPECT_EQ(scene.report.strands, 2u);
  EXPECT_EQ(scene.report.segments, 4u);
  EXPECT_EQ(scene.mesh.triangles.size(), 8u);
  EXPECT_EQ(scene.mesh.vertices.size(), 12u);
  EXPECT_EQ(scene.report.zero_area_triangles, 0u);
  EXPECT_EQ(scene.report.format, "hair");
  for (std::size_t strand = 0; strand < 2; ++strand)
    for (std::size_t i = 0; i < 3; ++i) expect_ribbon(scene.mesh, 3 * strand + i, kTwoStrands[strand][i], 0.1);
}

TEST_F(HairTest, strands_may_have_their_own_lengths_and_widths) {
  std::vector<std::vector<Vec3>> strands = kTwoStrands;
  strands[1].push_back({8, 2, 0});
  const Scene scene = load(write("a.hair", hair_file(strands, 9.0f, true, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.0f})));
  EXPECT_EQ(scene.report.segments, 5u);
  expect_ribbon(scene.mesh, 1, strands[0][1], 0.2);
  expect_ribbon(scene.mesh, 5, strands[1][2], 0.6);
  expect_ribbon(scene.mesh, 6, strands[1][3], 0.0);
  EXPECT_EQ(scene.report.zero_area_triangles, 1u) << "the tip comes to a point";
}

TEST_F(HairTest, the_width_of_the_option_comes_first) {
  LoadOptions options;
  options.strand_thickness = 0.25f;
  const Scene scene = load(write("a.hair", hair_file(kTwoStrands, 0.1f, true)), options);
  expect_ribbon(scene.mesh, 4, kTwoStrands[1][1], 0.25);
}

TEST_F(HairTest, ribbons_lie_across_their_strands_and_prefer_no_side) {
  std::vector<std::vector<Vec3>> strands;
  for (int n = 0; n < 4000; ++n) strands.push_back({{0, 0, float(n)}, {0, 0, float(n) + 0.5f}});
  const Scene scene = load(write("a.hair", hair_file(strands, 1.0f, false)));
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t n = 0; n < strands.size(); ++n) {
    const Vector64 across = Vector64(scene.mesh.vertices[4 * n + 1]) - Vector64(scene.mesh.vertices[4 * n]);
    EXPECT_EQ(across.z, 0);
    xx += across.x * across.x;
    yy += across.y * across.y;
    xy += across.x * across.y;
  }
  // cos^2 of a uniform angle has mean 1/2 and variance 1/8: five standard deviations of the mean of 4000 are 0.028.
  EXPECT_NEAR(xx / 4000, 0.5, 0.028);
  EXPECT_NEAR(yy / 4000, 0.5, 0.028);
  EXPECT_NEAR(xy / 4000, 0.0, 0.028);
}

TEST_F(HairTest, a_tube_has_two_triangles_a_side_and_corners_half_a_width_from_its_strand) {
  LoadOptions options;
  for (const int sides : {3, 4, kMostStrandSides}) {
    options.strand_sides = sides;
    const Scene scene = load(write("a.hair", hair_file(kTwoStrands, 0.1f, false)), options);
    const auto corners = static_cast<std::size_t>(sides);
    ASSERT_EQ(scene.mesh.vertices.size(), 6 * corners) << sides;
    EXPECT_EQ(scene.mesh.triangles.size(), 8 * corners) << sides;
    EXPECT_EQ(scene.report.zero_area_triangles, 0u) << sides;
    EXPECT_EQ(scene.report.segments, 4u) << sides;
    for (std::size_t v = 0; v < scene.mesh.vertices.size(); ++v) {
      const Vec3& centre = kTwoStrands[v / (3 * corners)][v / corners % 3];
      EXPECT_NEAR(distance(scene.mesh.vertices[v], centre), 0.05, 1e-6) << sides << " sides, vertex " << v;
    }
  }
}

TEST_F(HairTest, a_tube_is_closed_around_its_strand) {
  LoadOptions options;
  options.strand_sides = 5;
  const Scene scene = load(write("a.hair", hair_file({{{0, 0, 0}, {1, 2, 3}, {1, 4, 4}}}, 0.1f, false)), options);
  // Every edge inside belongs to two triangles that run through it in opposite directions; those of the two ends to
  // one.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& [a, b, c] : scene.mesh.triangles)
    for (const auto& edge : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) ++edges[edge];
  int alone = 0;
  for (const auto& [edge, times] : edges) {
    EXPECT_EQ(times, 1);
    alone += edges.count({edge.second, edge.first}) == 0;
  }
  EXPECT_EQ(alone, 2 * 5);
}

TEST_F(HairTest, a_strand_whose_points_fall_together_has_no_area_but_is_kept) {
  const Scene scene = load(write("a.hair", hair_file({{{1, 1, 1}, {1, 1, 1}}, {{0, 0, 0}, {0, 0, 1}}}, 0.1f, false)));
  EXPECT_EQ(scene.mesh.triangles.size(), 4u);
  EXPECT_EQ(scene.report.zero_area_triangles, 2u);
}

TEST_F(HairTest, damaged_files_are_errors) {
  const std::string good = hair_file(kTwoStrands, 0.1f, true);
  const auto with = [&](std::size_t offset, std::uint32_t value) {
    std::string bytes = good;
    bytes.replace(offset, 4, reinterpret_cast<const char*>(&value), 4);
    return write("bad.hair", bytes);
  };
  for (std::size_t bytes = 0; bytes < good.size(); ++bytes)
    EXPECT_THROW(load(write("cut.hair", good.substr(0, bytes))), Error) << bytes;
  expect_error(with(0, 0), "bad.hair", "does not start with 'HAIR'");
  expect_error(with(4, 4'000'000'000u), "byte 128", "4000000000 strands need more");
  expect_error(with(8, 4'000'000'000u), "byte 132", "4000000000 points need more");
  expect_error(with(4, 1), "byte 8", "belong to no strand");
  expect_error(with(8, 5), "strand 1", "only 2 are left");
  expect_error(with(12, 1), "byte 12", "no points");
  expect_error(with(12, 64 + 3), "byte 12", "unknown bits");
  expect_error(with(20, 0x7FC00000u), "byte 20", "thickness");
  expect_error(with(132, 0x7FC00000u), "(strand 0)", "NaN");
  expect_error(with(4, 0), "byte 8", "belong to no strand");
  expect_error(write("none.hair", hair_file({}, 0.1f, false)), "none.hair", "no triangles");
}

TEST_F(TfxTest, the_default_width_is_a_two_thousandth_of_the_diagonal) {
  const Scene scene = load(write("a.tfx", tfx_file(kTwoStrands)));
  EXPECT_EQ(scene.report.strands, 2u);
  EXPECT_EQ(scene.report.segments, 4u);
  EXPECT_EQ(scene.mesh.triangles.size(), 8u);
  EXPECT_EQ(scene.report.format, "tfx");
  const double diagonal = std::sqrt(7.0 * 7 + 1 + 2 * 2);
  EXPECT_NEAR(distance(scene.mesh.vertices[0], scene.mesh.vertices[1]), diagonal / 2000, 1e-7);
  expect_ribbon(scene.mesh, 4, kTwoStrands[1][1], diagonal / 2000);
}

TEST_F(TfxTest, damaged_files_are_errors) {
  const std::string good = tfx_file(kTwoStrands);
  const auto with = [&](std::size_t offset, std::uint32_t value) {
    std::string bytes = good;
    bytes.replace(offset, 4, reinterpret_cast<const char*>(&value), 4);
    return write("bad.tfx", bytes);
  };
  for (std::size_t bytes = 0; bytes < good.size(); ++bytes)
    EXPECT_THROW(load(write("cut.tfx", good.substr(0, bytes))), Error) << bytes;
  expect_error(with(0, 0), "byte 0", "version");
  expect_error(with(4, 0xFFFFFFFFu), "byte 160", "vertices need more");
  expect_error(with(8, 1), "byte 8", "fewer than two");
  expect_error(with(8, 0xFFFFFFFFu), "byte 160", "vertices need more");
  expect_error(with(12, 0xFFFFFFFFu), "byte 12", "begin at byte");
  expect_error(with(160, 0x7F800000u), "byte", "NaN or infinite");
  expect_error(with(4, 0), "bad.tfx", "no triangles");
}

}  // namespace
}  // namespace ctu::scene::test
