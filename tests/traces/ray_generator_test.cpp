// Rays by closed forms: where the camera looks, how directions are distributed, and that nothing but the options
// decides.
#include "traces/ray_generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/cull/mask_test.h"
#include "model/reference/traversal.h"
#include "tests/traces/test_support.h"
#include "traces/sampling.h"

namespace ctu::traces {
namespace {

using intersect::Hit;
using intersect::Ray;
using Rays = RayOptions::Rays;

struct Generated {
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

/// A scene with its tree, and rays made from it.
class Studio {
 public:
  explicit Studio(scene::Scene scene)
      : scene_(std::move(scene)),
        bvh_(accel::build(scene_.mesh, {})),
        tester_(cull::Design::None, {}),
        traversal_(bvh_, nullptr, tester_) {}

  const scene::Scene& scene() const { return scene_; }
  TraceRay tracer() const {
    return [this](const Ray& ray, bool) { return traversal_.trace(ray); };
  }
  Generated generate(const RayOptions& options) const {
    Generated out;
    const RayGenerator generator(scene_, options);
    generator.generate(0, generator.paths(), tracer(), out.rays, out.hits);
    return out;
  }

 private:
  scene::Scene scene_;
  accel::Bvh4 bvh_;
  cull::MaskTester tester_;
  reference::Traversal traversal_;
};

RayOptions options_of(Rays kind, std::uint32_t width, std::uint32_t height) {
  RayOptions options;
  options.kind = kind;
  options.width = width;
  options.height = height;
  return options;
}

TEST(Sampling, given_the_published_vectors_then_the_generator_is_philox4x32_10) {
  const auto words = [](std::uint64_t seed, std::uint64_t item, std::uint32_t sample, std::uint32_t dimension) {
    std::vector<std::uint32_t> out;
    for (const double number : random_numbers(seed, item, sample, dimension))
      out.push_back(static_cast<std::uint32_t>(number * 0x1p32));
    return out;
  };
  using Words = std::vector<std::uint32_t>;
  EXPECT_EQ(words(0, 0, 0, 0), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(words(0x299f31d0a4093822, 0x85a308d3243f6a88, 0x13198a2e, 0x03707344),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Sampling, the_power_series_are_sine_and_cosine) {
  for (int i = -1000; i <= 1000; ++i) {
    const double x = i * (1.5707963267948966 / 1000);
    EXPECT_NEAR(sin_cos(x).sin, std::sin(x), 5e-16);
    EXPECT_NEAR(sin_cos(x).cos, std::cos(x), 5e-16);
  }
}

TEST(Sampling, the_sphere_map_has_the_moments_of_the_uniform_distribution) {
  double z = 0, z2 = 0, x2 = 0, worst = 0;
  constexpr int kSide = 400;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const Vec3d p = sphere_point((i + 0.5) / kSide, (j + 0.5) / kSide);
      worst = std::max(worst, std::abs(length(p) - 1));
      z += p.z, z2 += p.z * p.z, x2 += p.x * p.x;
    }
  constexpr double kCount = static_cast<double>(kSide) * kSide;
  EXPECT_LT(worst, 1e-14);
  EXPECT_NEAR(z / kCount, 0, 1e-4);
  EXPECT_NEAR(z2 / kCount, 1.0 / 3, 1e-4);
  EXPECT_NEAR(x2 / kCount, 1.0 / 3, 1e-4);
}

TEST(PrimaryRays, given_no_jitter_then_they_go_through_the_pixel_centres) {
  const Studio studio(test::square_scene(100));
  RayOptions options = options_of(Rays::Primary, 12, 8);
  options.jitter = false;
  const Generated out = studio.generate(options);
  ASSERT_EQ(out.rays.size(), 96u);
  for (std::size_t i = 0; i < out.rays.size(); ++i) {
    // A field of view of 90 degrees: at distance 5 the picture is 10 high and 15 wide.
    const double x = ((static_cast<double>(i % 12) + 0.5) / 12 - 0.5) * 15,
                 y = (0.5 - (static_cast<double>(i / 12) + 0.5) / 8) * 10;
    const Ray& ray = out.rays[i];
    EXPECT_EQ(ray.origin, (Vec3{0, 0, 5}));
    EXPECT_EQ(ray.tmin, 0);
    EXPECT_TRUE(std::isinf(ray.tmax));
    const double t = out.hits[i].t;
    EXPECT_NEAR(ray.direction.x * t, x, 1e-5);
    EXPECT_NEAR(ray.direction.y * t, y, 1e-5);
    EXPECT_NEAR(t, std::sqrt(x * x + y * y + 25), 1e-5);
  }
}

TEST(PrimaryRays, given_jitter_then_every_sample_lies_in_its_pixel_and_they_average_to_its_centre) {
  const Studio studio(test::square_scene(1));
  RayOptions options = options_of(Rays::Primary, 5, 5);
  options.samples_per_pixel = 400;
  const RayGenerator generator(studio.scene(), options);
  double mean = 0;
  for (std::uint32_t y = 0; y < 5; ++y)
    for (std::uint32_t x = 0; x < 5; ++x)
      for (std::uint32_t s = 0; s < 400; ++s) {
        const Vec3 d = generator.primary_ray(x, y, s).direction;
        const double across = (d.x / -d.z + 1) * 2.5 - x, down = (1 - d.y / -d.z) * 2.5 - y;
        EXPECT_GT(across, -1e-5);
        EXPECT_LT(across, 1 + 1e-5);
        EXPECT_GT(down, -1e-5);
        EXPECT_LT(down, 1 + 1e-5);
        mean += across + down;
      }
  EXPECT_NEAR(mean / (2 * 25 * 400), 0.5, 4 * std::sqrt(1.0 / 12 / 20000));
}

TEST(PrimaryRays, given_tiles_then_they_are_the_same_rays_in_another_order) {
  const Studio studio(test::square_scene(1));
  for (const auto& [width, height] : {std::pair{24u, 16u}, std::pair{13u, 19u}, std::pair{3u, 2u}}) {
    RayOptions options = options_of(Rays::Primary, width, height);
    const auto directions = [&] {
      std::vector<std::array<float, 3>> list;
      for (const Ray& ray : studio.generate(options).rays)
        list.push_back({ray.direction.x, ray.direction.y, ray.direction.z});
      return list;
    };
    auto rows = directions();
    options.tiled = true;
    auto tiles = directions();
    if (width > 8) {
      EXPECT_NE(rows, tiles);
      EXPECT_EQ(tiles[8], rows[width]);  // ray 8 of a tile begins its second row
    }
    std::sort(rows.begin(), rows.end());
    std::sort(tiles.begin(), tiles.end());
    EXPECT_EQ(rows, tiles);
  }
}

TEST(DiffuseRays, bounces_are_cosine_distributed_about_the_normal) {
  const Studio studio(test::square_scene(1000));
  RayOptions options = options_of(Rays::Diffuse, 200, 200);
  options.bounces = 1;
  options.skip_primary = true;
  options.seed = test::test_seed(5);
  RecordProperty("seed", std::to_string(options.seed));
  const Generated out = studio.generate(options);
  ASSERT_EQ(out.rays.size(), 40000u);
  double x = 0, y = 0, z = 0, z2 = 0, z4 = 0;
  for (const Ray& ray : out.rays) {
    const Vec3& d = ray.direction;
    EXPECT_GE(d.z, 0);
    EXPECT_NEAR(dot(widen(d), widen(d)), 1, 1e-6);
    x += d.x, y += d.y, z += d.z, z2 += d.z * d.z, z4 += std::pow(d.z, 4);
  }
  const double n = static_cast<double>(out.rays.size());
  // With density cos/pi: E[cos] = 2/3, E[cos^2] = 1/2, E[cos^4] = 1/3; five standard errors.
  EXPECT_NEAR(x / n, 0, 5 * std::sqrt(0.25 / n));
  EXPECT_NEAR(y / n, 0, 5 * std::sqrt(0.25 / n));
  EXPECT_NEAR(z / n, 2.0 / 3, 5 * std::sqrt((1.0 / 2 - 4.0 / 9) / n));
  EXPECT_NEAR(z2 / n, 1.0 / 2, 5 * std::sqrt((1.0 / 3 - 1.0 / 4) / n));
  EXPECT_NEAR(z4 / n, 1.0 / 3, 5 * std::sqrt((1.0 / 5 - 1.0 / 9) / n));
}

/// The hair scene, moved far away from the origin, where coordinates have few digits left.
scene::Scene far_hair_scene(float distance) {
  scene::Scene scene = test::hair_scene();
  const auto move = [&](Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) v[axis] += distance;
  };
  for (Vec3& vertex : scene.mesh.vertices) move(vertex);
  for (Vec3* v : {&scene.lower, &scene.upper, &scene.camera.eye, &scene.camera.target}) move(*v);
  return scene;
}

TEST(DiffuseRays, a_bounce_never_meets_the_triangle_it_leaves) {
  for (const float distance : {0.0f, 100.0f, 1000.0f}) {
    SCOPED_TRACE(distance);
    const Studio studio(far_hair_scene(distance));
    RayOptions options = options_of(Rays::Diffuse, 96, 96);
    options.seed = test::test_seed(7);
    SCOPED_TRACE(options.seed);
    const Generated out = studio.generate(options);
    int bounces = 0;
    for (std::size_t i = 1; i < out.rays.size(); ++i) {
      if (out.rays[i].origin == studio.scene().camera.eye) continue;
      ++bounces;
      ASSERT_NE(out.hits[i - 1].primitive, intersect::kNoPrimitive) << "ray " << i << " goes on after a miss";
      EXPECT_NE(out.hits[i].primitive, out.hits[i - 1].primitive) << "ray " << i;
    }
    EXPECT_GT(bounces, 100);
  }
}

TEST(DiffuseRays, given_skip_primary_then_only_the_camera_rays_are_missing) {
  const Studio studio(test::hair_scene());
  RayOptions options = options_of(Rays::Diffuse, 40, 40);
  Generated all = studio.generate(options);
  std::erase_if(all.rays, [&](const Ray& ray) { return ray.origin == studio.scene().camera.eye; });
  options.skip_primary = true;
  EXPECT_TRUE(test::same_rays(studio.generate(options).rays, all.rays));
  EXPECT_FALSE(all.rays.empty());
}

TEST(ShadowRays, given_a_light_in_front_of_a_square_then_every_primary_hit_sees_it_and_none_when_it_is_behind) {
  const Studio studio(test::square_scene(2));
  const auto primary = studio.generate(options_of(Rays::Primary, 32, 32));
  const auto primary_hits = std::count_if(primary.hits.begin(), primary.hits.end(),
                                          [](const Hit& hit) { return hit.primitive != intersect::kNoPrimitive; });
  for (const float height : {3.0f, -3.0f}) {
    RayOptions options = options_of(Rays::Shadow, 32, 32);
    options.light = Vec3{0.5f, 0.25f, height};
    const Generated out = studio.generate(options);
    EXPECT_EQ(std::ssize(out.rays), primary_hits);
    for (std::size_t i = 0; i < out.rays.size(); ++i) {
      const Ray& ray = out.rays[i];
      EXPECT_EQ(ray.kind, intersect::RayKind::AnyHit);
      const Vec3d end = widen(ray.origin) + widen(ray.direction) * ray.tmax;
      EXPECT_LT(length(end - widen(*options.light)), 1e-5);
      EXPECT_EQ(out.hits[i].primitive == intersect::kNoPrimitive, height > 0);
    }
  }
}

TEST(ShadowRays, the_default_light_is_over_a_box_seen_from_outside_and_within_a_room) {
  scene::Scene scene = test::square_scene(2);
  scene.upper.z = 6;  // the camera at z = 5 stands in it
  EXPECT_LT(default_light(scene).y, 2);
  EXPECT_GT(default_light(scene).y, 1);
  scene.camera.eye.z = 50;
  EXPECT_GT(default_light(scene).y, 4);
}

TEST(AoRays, they_are_any_hit_rays_from_primary_hits_of_the_given_length) {
  const Studio studio(test::hair_scene());
  RayOptions options = options_of(Rays::Ao, 64, 64);
  options.ao_radius = 0.25f;
  const Generated out = studio.generate(options);
  ASSERT_FALSE(out.rays.empty());
  const double diagonal = length(widen(studio.scene().upper) - widen(studio.scene().lower));
  for (const Ray& ray : out.rays) {
    EXPECT_EQ(ray.kind, intersect::RayKind::AnyHit);
    EXPECT_NEAR(ray.tmax, 0.25 * diagonal, 1e-5);
  }
}

TEST(RandomRays, they_are_chords_of_a_sphere_around_the_scene) {
  const Studio studio(test::square_scene(3));
  RayOptions options = options_of(Rays::Random, 1, 1);
  options.count = 20000;
  options.seed = test::test_seed(9);
  RecordProperty("seed", std::to_string(options.seed));
  const Generated out = studio.generate(options);
  ASSERT_EQ(out.rays.size(), 20000u);
  const double radius = 0.505 * std::sqrt(72.0);
  double chord = 0, up = 0;
  for (const Ray& ray : out.rays) {
    EXPECT_NEAR(length(widen(ray.origin)), radius, 1e-5);
    chord += -2 * dot(widen(ray.origin), widen(ray.direction));
    up += ray.direction.z;
  }
  // Two uniform points on a sphere are 4/3 r apart on average, with variance 2 r^2 - (4/3 r)^2.
  const double n = 20000;
  EXPECT_NEAR(chord / n, 4.0 / 3 * radius, 5 * radius * std::sqrt((2 - 16.0 / 9) / n));
  EXPECT_NEAR(up / n, 0, 5 * std::sqrt(1.0 / 3 / n));
}

TEST(AllRays, given_any_cut_into_pieces_when_generated_piece_by_piece_then_the_rays_are_the_same) {
  const Studio studio(test::hair_scene());
  for (const Rays kind : {Rays::Primary, Rays::Diffuse, Rays::Shadow, Rays::Ao, Rays::Random}) {
    SCOPED_TRACE(to_string(kind));
    RayOptions options = options_of(kind, 17, 9);
    options.samples_per_pixel = 3;
    const Generated whole = studio.generate(options);
    const RayGenerator generator(studio.scene(), options);
    Generated pieces;
    for (std::uint64_t first = 0, size = 1; first < generator.paths(); first += size, size = size * 2 % 37)
      generator.generate(first, first + size, studio.tracer(), pieces.rays, pieces.hits);
    EXPECT_TRUE(test::same_rays(pieces.rays, whole.rays));
    EXPECT_TRUE(test::same_hits(pieces.hits, whole.hits));
    EXPECT_LE(whole.rays.size(), generator.paths() * generator.max_rays_per_path());
    for (const Ray& ray : whole.rays) EXPECT_TRUE(intersect::is_valid(ray));
    options.seed = 2;
    EXPECT_FALSE(test::same_rays(studio.generate(options).rays, whole.rays));
  }
}

TEST(AllRays, given_a_camera_that_looks_along_its_up_vector_then_the_rays_are_still_valid) {
  scene::Scene scene = test::square_scene(1);
  scene.camera.up = {0, 0, 1};
  const Studio studio(scene);
  for (const Ray& ray : studio.generate(options_of(Rays::Primary, 8, 8)).rays) EXPECT_TRUE(intersect::is_valid(ray));
}

TEST(AllRays, given_options_out_of_range_then_they_are_refused_by_name) {
  const scene::Scene scene = test::square_scene(1);
  const auto refused = [&](auto change, const std::string& name) {
    RayOptions options;
    change(options);
    try {
      const RayGenerator generator(scene, options);
      ADD_FAILURE() << name << " was accepted";
    } catch (const Error& problem) {
      EXPECT_NE(problem.problem().find(name), std::string::npos) << problem.what();
    }
  };
  refused([](RayOptions& o) { o.width = 0; }, "width");
  refused([](RayOptions& o) { o.height = 1u << 20; }, "height");
  refused([](RayOptions& o) { o.samples_per_pixel = 0; }, "samples_per_pixel");
  refused([](RayOptions& o) { o.bounces = 100000; }, "bounces");
  refused([](RayOptions& o) { o.ao_radius = -1; }, "ao_radius");
  refused([](RayOptions& o) { o.light = Vec3{NAN, 0, 0}; }, "light");
}

}  // namespace
}  // namespace ctu::traces
