// Generators of hard cases: made again from three numbers, valid, what their names say, and rays that really hit.
#include "sim/check/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/numeric/round.h"
#include "tests/check/hard_case_facts.h"
#include "tests/oracle/seed.h"

namespace ctu::sim::check {

void PrintTo(const Generator& generator, std::ostream* out) { *out << generator.name; }

namespace {

using intersect::Ray;
using numeric::bits;
using test::Box;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kScenes = 12;

std::uint32_t number_of(std::string_view name) {
  const auto all = generators();
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return i;
  throw std::logic_error("no generator " + std::string(name));
}

std::vector<HardCase> cases_of(std::string_view name, std::uint64_t scenes = kScenes) {
  std::vector<HardCase> cases;
  for (std::uint64_t scene = 0; scene < scenes; ++scene)
    cases.push_back(make_case(oracle::test_seed(), number_of(name), scene));
  return cases;
}

std::vector<std::uint32_t> all_bits(const HardCase& hard) {
  std::vector<std::uint32_t> all;
  const auto add = [&](const Vec3& v) { all.insert(all.end(), {bits(v.x), bits(v.y), bits(v.z)}); };
  for (const Vec3& v : hard.mesh.vertices) add(v);
  for (const auto& corners : hard.mesh.triangles) all.insert(all.end(), corners.begin(), corners.end());
  for (const Ray& ray : hard.rays) {
    add(ray.origin);
    add(ray.direction);
    all.insert(all.end(), {bits(ray.tmin), bits(ray.tmax), static_cast<std::uint32_t>(ray.kind)});
  }
  return all;
}

// ---------------------------------------------------------------------------------------------------- of every one

class EveryGenerator : public testing::TestWithParam<Generator> {};

TEST_P(EveryGenerator, makes_the_same_case_from_the_same_three_numbers) {
  SCOPED_TRACE(oracle::seed_note());
  const std::uint32_t number = number_of(GetParam().name);
  const std::uint64_t seed = oracle::test_seed();
  const HardCase fifth = make_case(seed, number, 5);
  for (const std::uint64_t scene : {0, 7}) make_case(seed, number, scene);
  EXPECT_EQ(all_bits(fifth), all_bits(make_case(seed, number, 5)));
  EXPECT_NE(all_bits(fifth), all_bits(make_case(seed, number, 6)));
  EXPECT_NE(all_bits(fifth), all_bits(make_case(seed + 1, number, 5)));
}

TEST_P(EveryGenerator, makes_valid_input_of_a_case_s_size) {
  SCOPED_TRACE(oracle::seed_note());
  for (const HardCase& hard : cases_of(GetParam().name)) {
    EXPECT_GE(hard.mesh.triangles.size(), 1u);
    EXPECT_LE(hard.mesh.triangles.size(), GetParam().name == "duplicates" ? 4000u : 300u);
    EXPECT_GE(hard.rays.size(), 64u);
    EXPECT_LE(hard.rays.size(), 1024u);
    for (const Ray& ray : hard.rays) EXPECT_TRUE(intersect::is_valid(ray));
    EXPECT_NO_THROW(accel::build(hard.mesh, {}));
  }
}

TEST_P(EveryGenerator, asks_for_closest_and_any_hits_in_ranges_of_all_kinds) {
  SCOPED_TRACE(oracle::seed_note());
  std::set<bool> any_hit, begins_at_zero, unbounded;
  for (const HardCase& hard : cases_of(GetParam().name))
    for (const Ray& ray : hard.rays) {
      any_hit.insert(ray.kind == intersect::RayKind::AnyHit);
      begins_at_zero.insert(ray.tmin == 0);
      unbounded.insert(ray.tmax == kInfinity);
    }
  EXPECT_EQ(any_hit.size(), 2u);
  EXPECT_EQ(begins_at_zero.size(), GetParam().name == "one-time" ? 1u : 2u);
  EXPECT_EQ(unbounded.size(), GetParam().name == "one-time" ? 1u : 2u);
}

TEST_P(EveryGenerator, sends_rays_that_hit) {
  SCOPED_TRACE(oracle::seed_note());
  constexpr std::size_t kAsked = 32;  // of each scene: exact arithmetic is slow
  int rays = 0, hits = 0;
  for (const HardCase& hard : cases_of(GetParam().name))
    for (std::size_t i = 0; i < hard.rays.size(); i += std::max<std::size_t>(1, hard.rays.size() / kAsked)) {
      ++rays;
      hits += test::exact_meeting(hard.mesh, hard.rays[i]).hit;
    }
  const double share = double(hits) / rays;
  RecordProperty("share_of_exact_hits", fmt::format("{:.3f}", share));
  EXPECT_GE(share, 0.4) << hits << " of " << rays;
}

INSTANTIATE_TEST_SUITE_P(HardCases, EveryGenerator, testing::ValuesIn(generators().begin(), generators().end()),
                         [](const auto& info) {
                           std::string name(info.param.name);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Generators, have_names_of_their_own_and_a_line_each) {
  std::set<std::string_view> names;
  for (const Generator& generator : generators()) {
    EXPECT_TRUE(names.insert(generator.name).second) << generator.name;
    EXPECT_EQ(generator.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string_view::npos);
    EXPECT_GE(generator.what.size(), 10u);
    EXPECT_EQ(generator.what.find('\n'), std::string_view::npos);
  }
  EXPECT_GE(names.size(), 30u);
}

// -------------------------------------------------------------------------------------------- what each one promises

/// The share of rays of some scenes for which the predicate holds.
using RayFact = std::function<bool(const HardCase&, const std::vector<Box>&, const Ray&)>;
double share_of_rays(std::string_view name, const RayFact& fact, bool with_boxes = false) {
  int rays = 0, holds = 0;
  for (const HardCase& hard : cases_of(name)) {
    const std::vector<Box> boxes = with_boxes ? test::boxes_of_tree(hard.mesh) : std::vector<Box>{};
    for (const Ray& ray : hard.rays) {
      ++rays;
      holds += fact(hard, boxes, ray);
    }
  }
  return double(holds) / rays;
}

int zero_components(const Ray& ray) { return (ray.direction.x == 0) + (ray.direction.y == 0) + (ray.direction.z == 0); }

bool is_subnormal(float x) { return x != 0 && std::fabs(x) < std::numeric_limits<float>::min(); }

/// Largest component over the smallest that is not zero.
double component_ratio(const Ray& ray) {
  double most = 0, least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double d = std::fabs(ray.direction[a]);
    most = std::max(most, d);
    if (d != 0) least = std::min(least, d);
  }
  return most / least;
}

bool has_zero_of_sign(const Ray& ray, bool negative) {
  for (int a = 0; a < 3; ++a)
    if (bits(ray.direction[a]) == (negative ? 0x80000000u : 0u)) return true;
  return false;
}

TEST(RayDirections, are_parallel_to_axes_with_zeros_of_both_signs) {
  EXPECT_EQ(share_of_rays("axis-parallel", [](auto&, auto&, const Ray& ray) { return zero_components(ray) == 2; }), 1);
  for (const char* name : {"axis-parallel", "zero-components"})
    for (const bool negative : {false, true})
      EXPECT_GE(share_of_rays(name, [&](auto&, auto&, const Ray& ray) { return has_zero_of_sign(ray, negative); }),
                0.4);
  EXPECT_GE(share_of_rays("zero-components", [](auto&, auto&, const Ray& ray) { return zero_components(ray) >= 1; }),
            0.99);
}

TEST(RayDirections, have_components_as_small_as_they_say) {
  EXPECT_GE(
      share_of_rays("nearly-axis-parallel", [](auto&, auto&, const Ray& ray) { return component_ratio(ray) >= 0x1p7; }),
      0.99);
  EXPECT_GE(
      share_of_rays("components-1e30-apart", [](auto&, auto&, const Ray& ray) { return component_ratio(ray) >= 1e26; }),
      0.9);
  EXPECT_GE(share_of_rays("subnormal-components",
                          [](auto&, auto&, const Ray& ray) {
                            return is_subnormal(ray.direction.x) || is_subnormal(ray.direction.y) ||
                                   is_subnormal(ray.direction.z);
                          }),
            0.8);
  EXPECT_GE(share_of_rays("subnormal-components",
                          [](auto&, auto&, const Ray& ray) {
                            for (int a = 0; a < 3; ++a)
                              if (!is_subnormal(ray.direction[a]) && ray.direction[a] != 0) return false;
                            return true;
                          }),
            0.1);
}

TEST(RayDirections, are_of_any_length) {
  const auto longest = [](const Ray& ray) {
    return std::max({std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)});
  };
  EXPECT_GE(share_of_rays("direction-lengths", [&](auto&, auto&, const Ray& ray) { return longest(ray) < 1e-36f; }),
            0.05);
  EXPECT_GE(share_of_rays("direction-lengths", [&](auto&, auto&, const Ray& ray) { return longest(ray) > 1e36f; }),
            0.02);
}

TEST(RayOrigins, lie_on_faces_edges_and_corners_of_boxes_of_the_tree) {
  const auto share_on = [](std::string_view name, int faces) {
    return share_of_rays(
        name,
        [&](auto&, const std::vector<Box>& boxes, const Ray& ray) {
          return std::any_of(boxes.begin(), boxes.end(),
                             [&](const Box& box) { return test::faces_met(box, ray.origin) >= faces; });
        },
        true);
  };
  EXPECT_GE(share_on("origins-on-faces", 1), 0.4);
  EXPECT_GE(share_on("origins-on-edges", 2), 0.3);
  EXPECT_GE(share_on("origins-on-corners", 3), 0.2);
}

TEST(RayOrigins, lie_on_cell_borders_for_every_resolution) {
  for (int r = 2; r <= 8; ++r)
    EXPECT_GE(share_of_rays(
                  "origins-on-cell-borders",
                  [&](auto&, const std::vector<Box>& boxes, const Ray& ray) {
                    return std::any_of(boxes.begin(), boxes.end(),
                                       [&](const Box& box) { return test::on_cell_border(box, ray.origin, r); });
                  },
                  true),
              0.1)
        << "R = " << r;
}

TEST(RayOrigins, lie_inside_of_boxes_and_on_the_geometry) {
  EXPECT_GE(share_of_rays(
                "origins-inside",
                [](auto&, const std::vector<Box>& boxes, const Ray& ray) {
                  return std::any_of(boxes.begin(), boxes.end(),
                                     [&](const Box& box) { return test::strictly_inside(box, ray.origin); });
                },
                true),
            0.6);
  int rays = 0, on = 0;
  for (const HardCase& hard : cases_of("origins-on-geometry", 4))
    for (std::size_t i = 0; i < hard.rays.size(); i += 8) {
      ++rays;
      on += test::exact_meeting(hard.mesh, hard.rays[i], 0, 0).hit;
    }
  EXPECT_GE(double(on) / rays, 0.3);
}

TEST(RayOrigins, lie_1e3_to_1e12_box_sizes_away) {
  double least = 1e300, most = 0;
  for (const HardCase& hard : cases_of("origins-far-away")) {
    const double size = test::longest_side(test::bounds(hard.mesh));
    for (const Ray& ray : hard.rays) {
      const double distance = scene::length(scene::Vector64(ray.origin)) / size;
      least = std::min(least, distance);
      most = std::max(most, distance);
    }
  }
  EXPECT_GE(least, 1e2);  // of the scene, which is up to four boxes wide
  EXPECT_LE(least, 1e4);
  EXPECT_GE(most, 2e11);
}

TEST(RayOrigins, are_far_while_directions_are_powers_of_two_on_some_axes) {
  EXPECT_GE(share_of_rays("far-and-exact",
                          [](const HardCase& hard, auto&, const Ray& ray) {
                            int exact_axes = 0, rounded_axes = 0;
                            for (int a = 0; a < 3; ++a) {
                              int exponent = 0;
                              const bool power = std::frexp(std::fabs(ray.direction[a]), &exponent) == 0.5f;
                              if (ray.direction[a] != 0) ++(power ? exact_axes : rounded_axes);
                            }
                            const double size = test::longest_side(test::bounds(hard.mesh));
                            const bool far = scene::length(scene::Vector64(ray.origin)) >= 1e3 * size;
                            return far && exact_axes >= 1 && rounded_axes >= 1;
                          }),
            0.4);
}

TEST(RayIntervals, begin_or_end_where_they_say) {
  EXPECT_EQ(share_of_rays("one-time", [](auto&, auto&, const Ray& ray) { return ray.tmin == ray.tmax; }), 1);
  for (const char* name : {"ends-inside-cells", "ends-on-cell-borders"}) {
    EXPECT_EQ(share_of_rays(name, [](auto&, auto&, const Ray& ray) { return ray.tmin > 0 || ray.tmax < kInfinity; }),
              1);
    // The end is the time of what is hit, or next to it.
    int hits = 0, at_end = 0;
    for (const HardCase& hard : cases_of(name, 4))
      for (std::size_t i = 0; i < hard.rays.size(); i += 8) {
        const Ray& ray = hard.rays[i];
        const test::ExactMeeting meeting = test::exact_meeting(hard.mesh, ray);
        if (!meeting.hit) continue;
        ++hits;
        const auto near = [&](float end) { return std::fabs(meeting.t - end) <= 1e-6 * meeting.t; };
        at_end += near(ray.tmin) || near(ray.tmax);
      }
    EXPECT_GE(hits, 30);
    EXPECT_GE(double(at_end) / hits, 0.5);
  }
}

/// Shares of exactly judged rays that hit at all, on an edge or vertex, and within a triangle's plane.
struct EdgeShares {
  double hit, on_edge, edge_on;
};
EdgeShares edge_shares(std::string_view name) {
  int rays = 0, hit = 0, on_edge = 0, edge_on = 0;
  for (const HardCase& hard : cases_of(name, 8))
    for (std::size_t i = 0; i < hard.rays.size(); i += 6) {
      const test::ExactMeeting meeting = test::exact_meeting(hard.mesh, hard.rays[i]);
      ++rays;
      hit += meeting.hit;
      on_edge += meeting.on_edge || meeting.edge_on;
      edge_on += meeting.edge_on;
    }
  return {double(hit) / rays, double(on_edge) / rays, double(edge_on) / rays};
}

TEST(AimedRays, meet_edges_and_vertices_exactly) {
  EXPECT_GE(edge_shares("through-vertices").on_edge, 0.4);
  EXPECT_GE(edge_shares("through-edges").on_edge, 0.3);
  EXPECT_GE(edge_shares("through-cell-corners").on_edge, 0.4);
  EXPECT_GE(edge_shares("closed-meshes").on_edge, 0.3);
  EXPECT_GE(edge_shares("grazing").edge_on, 0.2);
}

TEST(AimedRays, never_leave_a_closed_mesh_exactly) {
  int inside = 0;
  for (const HardCase& hard : cases_of("closed-meshes", 6))
    for (const Ray& ray : hard.rays) {
      const Box box = test::bounds(hard.mesh);
      if (ray.tmin > 0 || ray.tmax < kInfinity || !test::strictly_inside(box, ray.origin)) continue;
      ++inside;
      EXPECT_TRUE(test::exact_meeting(hard.mesh, ray, -kInfinity, kInfinity).hit);
    }
  EXPECT_GE(inside, 100);
}

TEST(BoxShapes, are_flat_in_one_two_and_three_axes) {
  const std::pair<const char*, int> promised[] = {{"flat-boxes", 1}, {"line-boxes", 2}, {"point-boxes", 3}};
  for (const auto& [name, flat] : promised) {
    int boxes = 0, flat_boxes = 0;
    for (const HardCase& hard : cases_of(name))
      for (std::size_t triangle = 0; triangle < hard.mesh.triangles.size(); ++triangle) {
        const auto& corners = hard.mesh.triangles[triangle];
        scene::Mesh alone;
        for (const std::uint32_t corner : corners) alone.vertices.push_back(hard.mesh.vertices[corner]);
        ++boxes;
        flat_boxes += test::flat_axes(test::bounds(alone)) == flat;
      }
    EXPECT_GE(double(flat_boxes) / boxes, 0.3) << name;
  }
}

TEST(BoxShapes, are_of_aspect_1_to_1e9) {
  double most = 0;
  for (const HardCase& hard : cases_of("aspects", 40)) {
    const double aspect = test::aspect(test::bounds(hard.mesh));
    most = std::max(most, aspect);
    EXPECT_LE(aspect, 4.1e9 * 4);
  }
  EXPECT_GE(most, 1e8);
}

TEST(BoxShapes, lie_far_from_zero_for_their_size) {
  double farthest = 0, least_ratio = 1e300, most_ratio = 0;
  for (const HardCase& hard : cases_of("offsets", 100)) {
    const Box box = test::bounds(hard.mesh);
    const double distance = scene::length(scene::Vector64(box.lower));
    farthest = std::max(farthest, distance);
    const double ratio = distance / test::longest_side(box);
    least_ratio = std::min(least_ratio, ratio);
    most_ratio = std::max(most_ratio, ratio);
  }
  EXPECT_GE(farthest, 1e29);
  EXPECT_GE(least_ratio, 1);
  EXPECT_GE(most_ratio, 1000);
}

/// Places on the binary32 line between two numbers of one sign.
std::int64_t ulps_apart(float a, float b) {
  return std::abs(static_cast<std::int64_t>(bits(a)) - static_cast<std::int64_t>(bits(b)));
}

TEST(BoxShapes, are_a_few_units_in_the_last_place_wide) {
  int boxes = 0, narrow = 0;
  for (const HardCase& hard : cases_of("few-ulps-wide"))
    for (const Box& box : test::boxes_of_tree(hard.mesh)) {
      int narrow_axes = 0;
      for (int a = 0; a < 3; ++a) narrow_axes += ulps_apart(box.lower[a], box.upper[a]) <= 60;
      ++boxes;
      narrow += narrow_axes >= 2;  // one axis may lie at zero
    }
  EXPECT_GE(double(narrow) / boxes, 0.9);
}

TEST(BoxShapes, touch_the_largest_finite_number) {
  for (const HardCase& hard : cases_of("largest-numbers")) {
    const Box box = test::bounds(hard.mesh);
    for (int a = 0; a < 3; ++a)
      EXPECT_TRUE(box.upper[a] == std::numeric_limits<float>::max() ||
                  box.lower[a] == std::numeric_limits<float>::lowest());
  }
}

TEST(Scales, are_of_the_size_they_say) {
  const auto expect_size = [](std::string_view name, double least, double most) {
    for (const HardCase& hard : cases_of(name)) {
      const double size = test::longest_side(test::bounds(hard.mesh));
      EXPECT_GE(size, least) << name;
      EXPECT_LE(size, most) << name;
    }
  };
  expect_size("tiny-scenes", 1e-22, 1e-19);
  expect_size("huge-scenes", 1e18, 1e22);
  expect_size("subnormal-scenes", 1e-43, 1e-36);
}

TEST(Scales, are_nested_in_one_tree) {
  double most = 0;
  for (const HardCase& hard : cases_of("nested-scales")) {
    double longest = 0, shortest = 1e300;
    for (std::size_t i = 0; i < hard.mesh.triangles.size(); ++i) {
      const double edge = test::longest_edge(hard.mesh, i);
      longest = std::max(longest, edge);
      if (edge > 0) shortest = std::min(shortest, edge);
    }
    EXPECT_GE(longest / shortest, 30);
    most = std::max(most, longest / shortest);
  }
  EXPECT_GE(most, 1e10);
}

TEST(Scales, hair_is_1e6_of_its_scene_wide) {
  for (const HardCase& hard : cases_of("hair")) {
    const double scene = test::longest_side(test::bounds(hard.mesh));
    for (std::size_t i = 0; i < hard.mesh.triangles.size(); ++i) {
      const double width = test::thinness(hard.mesh, i) * test::longest_edge(hard.mesh, i);
      EXPECT_LE(width / scene, 2e-5);
      EXPECT_GE(width / scene, 1e-7);
    }
  }
}

TEST(Meshes, needles_are_thin) {
  int thin = 0, triangles = 0;
  for (const HardCase& hard : cases_of("needles"))
    for (std::size_t i = 0; i < hard.mesh.triangles.size(); ++i, ++triangles)
      thin += test::thinness(hard.mesh, i) <= 2e-3;
  EXPECT_GE(double(thin) / triangles, 0.9);
}

TEST(Meshes, degenerate_triangles_have_no_area_and_others_are_among_them) {
  int none = 0, some = 0;
  for (const HardCase& hard : cases_of("degenerate-triangles"))
    for (std::size_t i = 0; i < hard.mesh.triangles.size(); ++i) ++(test::thinness(hard.mesh, i) == 0 ? none : some);
  EXPECT_GE(none, some);
  EXPECT_GE(some, 20);
}

TEST(Meshes, duplicates_come_by_the_thousand) {
  for (const HardCase& hard : cases_of("duplicates", 4)) {
    std::map<std::vector<std::uint32_t>, int> copies;
    for (const auto& corners : hard.mesh.triangles) {
      std::vector<std::uint32_t> all;
      for (const std::uint32_t corner : corners)
        for (int a = 0; a < 3; ++a) all.push_back(bits(hard.mesh.vertices[corner][a]));
      ++copies[all];
    }
    EXPECT_LE(copies.size(), 3u);
    for (const auto& [triangle, count] : copies) EXPECT_GE(count, 1000);
  }
}

TEST(Meshes, any_bits_are_of_any_exponent) {
  std::set<int> exponents;
  for (const HardCase& hard : cases_of("any-bits"))
    for (const Vec3& v : hard.mesh.vertices) exponents.insert(static_cast<int>(bits(v.x) >> 23 & 255));
  EXPECT_GE(exponents.size(), 100u);
}

}  // namespace
}  // namespace ctu::sim::check
