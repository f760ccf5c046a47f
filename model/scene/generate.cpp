#include "model/scene/generate.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/scene/parameters.h"
#include "model/scene/random.h"
#include "model/scene/strands.h"
#include "model/scene/turn.h"

namespace ctu::scene {
namespace {

constexpr std::uint64_t kAnySeed = ~std::uint64_t{0};
constexpr std::uint64_t kMostItems = 4'000'000;
constexpr double kLargest = 1e6;

struct StrandSettings {
  std::uint64_t strands, segments, seed;
  double width;
};

StrandSettings strand_settings(Parameters& p, std::uint64_t segments, const Draft& draft) {
  StrandSettings s{};
  s.strands = p.whole("strands", 2000, 1, kMostItems);
  s.segments = p.whole("segments", segments, 1, 4096);
  s.seed = p.whole("seed", 1, 0, kAnySeed);
  s.width = p.real("thickness", 0.002, 0, kLargest);
  if (draft.options.strand_thickness > 0) s.width = draft.options.strand_thickness;
  return s;
}

// A strand from `root` in direction `along`, bent by three random numbers: spread = 0 is a straight line.
std::vector<StrandPoint> bent_strand(const Vector64& root, const Vector64& along, const Vector64& bend, double length,
                                     const StrandSettings& s) {
  std::vector<StrandPoint> points;
  for (std::uint64_t i = 0; i <= s.segments; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(s.segments);
    points.push_back({root + along * (length * t) + bend * (length * t * t), s.width});
  }
  return points;
}

void hair_ball(Parameters& p, const std::string& where, Draft& draft) {
  const StrandSettings s = strand_settings(p, 8, draft);
  const double radius = p.real("radius", 1, 0, kLargest), length = p.real("length", 1, 0, kLargest);
  const double spread = p.real("spread", 0.15, 0, 10);
  p.expect_all_used();
  require_room_for_strands(where, s.strands, s.strands * (s.segments + 1), draft);
  for (std::uint64_t n = 0; n < s.strands; ++n) {
    Random random(s.seed, n);
    const Vector64 outward = random.direction();
    append_strand(bent_strand(outward * radius, outward, random.in_ball() * spread, length, s), n, where, draft);
  }
}

void curly_hair(Parameters& p, const std::string& where, Draft& draft) {
  const StrandSettings s = strand_settings(p, 32, draft);
  const double radius = p.real("radius", 1, 0, kLargest), length = p.real("length", 1, 0, kLargest);
  const double curls = p.real("curls", 4, 0, 1000), curl_radius = p.real("curl-radius", 0.05, 0, kLargest);
  p.expect_all_used();
  require_room_for_strands(where, s.strands, s.strands * (s.segments + 1), draft);
  for (std::uint64_t n = 0; n < s.strands; ++n) {
    Random random(s.seed, n);
    const Vector64 outward = random.direction();
    const Vector64 u = any_across(outward), v = cross(outward, u);
    const double phase = random.unit(), tightness = random.between(0.75, 1.25);
    std::vector<StrandPoint> points;
    for (std::uint64_t i = 0; i <= s.segments; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(s.segments);
      const Turn angle = turn(phase + curls * tightness * t);
      const double wide = curl_radius * std::min(1.0, 4 * t);  // the curl opens over the first quarter
      points.push_back(
          {outward * (radius + length * t) + u * (wide * angle.cosine) + v * (wide * angle.sine), s.width});
    }
    append_strand(points, n, where, draft);
  }
}

void straight_hair(Parameters& p, const std::string& where, Draft& draft) {
  const StrandSettings s = strand_settings(p, 8, draft);
  const double length = p.real("length", 2, 0, kLargest), tilt = p.real("tilt", 35, -360, 360);
  const double spread = p.real("spread", 0.05, 0, 10);
  p.expect_all_used();
  require_room_for_strands(where, s.strands, s.strands * (s.segments + 1), draft);
  const Turn lean = turn(tilt / 360);
  // Leans toward (0.8, 0.6) of the ground, along no axis.
  const Vector64 along{0.8 * lean.sine, 0.6 * lean.sine, lean.cosine};
  for (std::uint64_t n = 0; n < s.strands; ++n) {
    Random random(s.seed, n);
    const Vector64 root{random.between(-1, 1), random.between(-1, 1), 0};
    const Vector64 own = normalized(along + random.in_ball() * spread, along);
    append_strand(bent_strand(root, own, random.in_ball() * (0.5 * spread), length, s), n, where, draft);
  }
}

void append_quad(const Vector64& center, const Vector64& half_u, const Vector64& half_v, Draft& draft) {
  auto& vertices = draft.mesh.vertices;
  auto& triangles = draft.mesh.triangles;
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.push_back((center - half_u - half_v).rounded());
  vertices.push_back((center + half_u - half_v).rounded());
  vertices.push_back((center + half_u + half_v).rounded());
  vertices.push_back((center - half_u + half_v).rounded());
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
}

void tilted_quads(Parameters& p, const std::string& where, Draft& draft) {
  const std::uint64_t quads = p.whole("quads", 2000, 1, kMostItems), seed = p.whole("seed", 1, 0, kAnySeed);
  const double size = p.real("size", 0.1, 0, kLargest), aspect = p.real("aspect", 8, 1, kLargest);
  p.expect_all_used();
  draft.require_room(where, 4 * quads, 2 * quads);
  for (std::uint64_t n = 0; n < quads; ++n) {
    Random random(seed, n);
    const Vector64 center{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const Vector64 u = random.direction();
    const Vector64 v = normalized(cross(u, random.direction()), any_across(u));
    append_quad(center, u * (0.5 * size), v * (0.5 * size / aspect), draft);
  }
}

// Twigs grow outward from the inside of a crown that is taller than wide; cards sit along each twig and hang a little.
void foliage(Parameters& p, const std::string& where, Draft& draft) {
  const std::uint64_t twigs = p.whole("twigs", 200, 1, kMostItems), cards = p.whole("cards", 12, 1, 4096);
  const std::uint64_t seed = p.whole("seed", 1, 0, kAnySeed);
  const double size = p.real("size", 0.06, 0, kLargest), aspect = p.real("aspect", 2.5, 1, kLargest);
  p.expect_all_used();
  draft.require_room(where, 4 * twigs * cards, 2 * twigs * cards);
  for (std::uint64_t n = 0; n < twigs; ++n) {
    Random random(seed, n);
    const Vector64 place = random.in_ball();
    const Vector64 start{place.x, place.y, 2 + 1.5 * place.z};
    const Vector64 along = normalized(place + random.direction() * 0.5, {0, 0, 1});
    for (std::uint64_t c = 0; c < cards; ++c) {
      const double t = 0.4 * static_cast<double>(c + 1) / static_cast<double>(cards);
      const Vector64 stalk = normalized(random.direction() + along * 0.7 - Vector64{0, 0, 0.4}, along);
      const Vector64 side = normalized(cross(stalk, random.direction()), any_across(stalk));
      append_quad(start + along * t + stalk * (0.5 * size), stalk * (0.5 * size), side * (0.5 * size / aspect), draft);
    }
  }
}

// Haines' Standard Procedural Databases, "tetra": each tetrahedron is replaced by four of half its size at its corners.
// The corners are those of the cube [-1, 1]^3 with an odd number of coordinates at +1; every number is exact.
void tetrahedron(const Vec3& center, float half, std::uint64_t depth, Mesh& mesh) {
  constexpr Vec3 kCorners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const auto corner = [&](int i, float scale) {
    return Vec3{center.x + kCorners[i].x * scale, center.y + kCorners[i].y * scale, center.z + kCorners[i].z * scale};
  };
  if (depth > 1) {
    for (int i = 0; i < 4; ++i) tetrahedron(corner(i, half / 2), half / 2, depth - 1, mesh);
    return;
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 4; ++i) mesh.vertices.push_back(corner(i, half));
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  mesh.triangles.push_back({first, first + 3, first + 1});
  mesh.triangles.push_back({first + 1, first + 3, first + 2});
}

void tetra(Parameters& p, const std::string& where, Draft& draft) {
  const std::uint64_t depth = p.whole("depth", 6, 1, 12);
  p.expect_all_used();
  draft.require_room(where, std::uint64_t{1} << (2 * depth), std::uint64_t{1} << (2 * depth));
  tetrahedron({0, 0, 0}, 1, depth, draft.mesh);
}

/// The nine directions of a sphere's children about its own, +z: three on its upper side and six around its equator,
/// with which all nine and the parent touch. The three of SPD are (1,1,0), (1,0,-1) and (0,1,-1), turned about
/// (1,-1,0) by the angle whose sine is 2/sqrt(6); the others are these turned about z by thirds.
std::array<Vector64, 9> sphereflake_directions() {
  const Vector64 first[3] = {{1, 1, 0}, {1, 0, -1}, {0, 1, -1}};
  const Vector64 axis = Vector64{1, -1, 0} * std::sqrt(0.5);
  const double sine = 2 / std::sqrt(6.0), cosine = std::sqrt(1.0 / 3);
  std::array<Vector64, 9> all;
  for (std::size_t i = 0; i < 9; ++i) {
    const Vector64 v = first[i % 3] * std::sqrt(0.5);
    const Vector64 leant = v * cosine + cross(axis, v) * sine + axis * (dot(axis, v) * (1 - cosine));
    const Turn third = turn(static_cast<double>(i / 3) / 3);
    all[i] = {leant.x * third.cosine - leant.y * third.sine, leant.x * third.sine + leant.y * third.cosine, leant.z};
  }
  return all;
}

/// `v` under the rotation that takes +z to the unit vector `z` by the shortest way. Straight down any way is as short,
/// and SPD turns about y; where rounding hides that a direction is straight down, SPD leaves the way to it.
Vector64 turned_with(const Vector64& z, const Vector64& v) {
  if (z.z <= -1 + 1e-9) return {-v.x, v.y, -v.z};
  const Vector64 axis = cross({0, 0, 1}, z);  // of length sin
  return v * z.z + cross(axis, v) + axis * (dot(axis, v) / (1 + z.z));
}

void sphereflake(const Vector64& centre, double radius, const Vector64& along, std::uint64_t depth,
                 const std::array<Vector64, 9>& directions, Mesh& mesh) {
  mesh.spheres.push_back({centre.rounded(), static_cast<float>(radius)});
  if (depth == 0) return;
  for (const Vector64& direction : directions) {
    const Vector64 outward = turned_with(along, direction);
    sphereflake(centre + outward * (radius + radius / 3), radius / 3, outward, depth - 1, directions, mesh);
  }
}

/// Haines' Standard Procedural Databases, "balls": the sphereflake over a square, seen by the database's camera.
void balls(Parameters& p, const std::string& where, Draft& draft) {
  const std::uint64_t depth = p.whole("depth", 4, 0, 7);
  p.expect_all_used();
  std::uint64_t spheres = 1;
  for (std::uint64_t level = 0; level < depth; ++level) spheres = 9 * spheres + 1;
  draft.require_room(where, 4, 2);
  draft.require_room_for_spheres(where, spheres);
  constexpr float kHalf = 12, kGround = -0.5f;
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}})
    draft.mesh.vertices.push_back({kHalf * static_cast<float>(x), kHalf * static_cast<float>(y), kGround});
  draft.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  sphereflake({0, 0, 0}, 0.5, {0, 0, 1}, depth, sphereflake_directions(), draft.mesh);
  draft.camera = Camera{{2.1f, 1.3f, 1.7f}, {0, 0, 0}, {0, 0, 1}, 45, true};
}

struct Generator {
  const char* name;
  void (*make)(Parameters&, const std::string&, Draft&);
};

constexpr Generator kGenerators[] = {
    {"hair-ball", hair_ball},
    {"curly-hair", curly_hair},
    {"straight-hair", straight_hair},
    {"tilted-quads", tilted_quads},
    {"foliage", foliage},
    {"tetra", tetra},
    {"balls", balls},
};

}  // namespace

void generate(const std::string& name, Draft& draft) {
  draft.add_format("generated");
  Parameters parameters(name, std::string_view(name).substr(std::string_view(kGeneratorPrefix).size()));
  for (const Generator& generator : kGenerators)
    if (parameters.name() == generator.name) return generator.make(parameters, name, draft);
  std::vector<std::string> known;
  for (const Generator& generator : kGenerators) known.emplace_back(generator.name);
  std::string all;
  for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
  throw Error(name, fmt::format("there is no generator '{}'", parameters.name()),
              fmt::format("did you mean '{}'? Known: {}", nearest_name(parameters.name(), known), all));
}

}  // namespace ctu::scene
