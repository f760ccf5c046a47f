#include "model/influence/light_fit.h"

#include <cmath>

#include "model/scene/random.h"

namespace ctu::influence {
namespace {

using scene::Vector64;

constexpr double kParallel = 1e-5;  // the sine of the angle below which two lines have no crossing worth a guess

/// The middle of where two lines are nearest to each other, if that is ahead on both.
std::optional<Vector64> crossing(const Sight& a, const Sight& b) {
  const double along = scene::dot(a.direction, b.direction), sine2 = 1 - along * along;
  if (!(sine2 > kParallel * kParallel)) return std::nullopt;
  const Vector64 between = b.origin - a.origin;
  const double on_a = scene::dot(between, a.direction), on_b = scene::dot(between, b.direction);
  const double s = (on_a - along * on_b) / sine2, t = (along * on_a - on_b) / sine2;
  if (!(s > 0 && t > 0)) return std::nullopt;
  return (a.origin + a.direction * s + b.origin + b.direction * t) * 0.5;
}

std::size_t votes(const Light& light, std::span<const Sight> sights, double least_cosine) {
  std::size_t count = 0;
  for (const Sight& sight : sights) count += agrees(light, sight, least_cosine) ? 1 : 0;
  return count;
}

/// A guess and how many rays agree.
struct Candidate {
  Light light;
  std::size_t votes = 0;

  void offer(const Light& other, std::size_t other_votes) {
    const bool simpler = other.kind == AreaKind::Plane && light.kind == AreaKind::Point;
    if (other_votes > votes || (other_votes == votes && simpler)) *this = {other, other_votes};
  }
};

/// The light of the same kind that fits the rays that agree best.
std::optional<Light> fitted(const Light& light, std::span<const Sight> sights,
                            const std::vector<std::uint32_t>& chosen) {
  if (light.kind == AreaKind::Point) {
    const auto place = nearest_point(sights, chosen);
    return place ? std::optional(Light{AreaKind::Point, *place}) : std::nullopt;
  }
  Vector64 sum;
  for (const std::uint32_t i : chosen) sum = sum + sights[i].direction;
  return Light{AreaKind::Plane, normalized(sum, light.place)};
}

/// Fits as long as that wins rays.
void refine(Candidate& candidate, std::span<const Sight> sights, double least_cosine) {
  constexpr int kRounds = 4;
  for (int i = 0; i < kRounds; ++i) {
    const auto better = fitted(candidate.light, sights, agreeing(candidate.light, sights, least_cosine));
    if (!better) return;
    const std::size_t count = votes(*better, sights, least_cosine);
    if (count < candidate.votes) return;
    const bool done = count == candidate.votes;
    candidate = {*better, count};
    if (done) return;
  }
}

}  // namespace

bool agrees(const Light& light, const Sight& sight, double least_cosine) {
  if (light.kind == AreaKind::Plane) return scene::dot(sight.direction, light.place) >= least_cosine;
  const Vector64 to = light.place - sight.origin;
  return scene::dot(sight.direction, to) >= least_cosine * scene::length(to);
}

std::vector<std::uint32_t> agreeing(const Light& light, std::span<const Sight> sights, double least_cosine) {
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < sights.size(); ++i)
    if (agrees(light, sights[i], least_cosine)) chosen.push_back(i);
  return chosen;
}

std::optional<Vector64> nearest_point(std::span<const Sight> sights, std::span<const std::uint32_t> chosen) {
  // Normal equations: the sum of I - d d^T over the lines, times the point, is the same sum times their origins.
  Vector64 row[3], right;
  for (const std::uint32_t i : chosen) {
    const Vector64 &d = sights[i].direction, &o = sights[i].origin;
    const Vector64 of_line[3] = {{1 - d.x * d.x, -d.x * d.y, -d.x * d.z},
                                 {-d.x * d.y, 1 - d.y * d.y, -d.y * d.z},
                                 {-d.x * d.z, -d.y * d.z, 1 - d.z * d.z}};
    for (int k = 0; k < 3; ++k) row[k] = row[k] + of_line[k];
    right = right + Vector64{scene::dot(of_line[0], o), scene::dot(of_line[1], o), scene::dot(of_line[2], o)};
  }
  const Vector64 yz = cross(row[1], row[2]), zx = cross(row[2], row[0]), xy = cross(row[0], row[1]);
  const double determinant = scene::dot(row[0], yz), count = static_cast<double>(chosen.size());
  if (!(determinant > 1e-12 * count * count * count)) return std::nullopt;
  return (yz * right.x + zx * right.y + xy * right.z) * (1 / determinant);
}

std::optional<Light> find_light(std::span<const Sight> sights, int guesses, std::size_t least_rays, double least_cosine,
                                std::uint64_t seed, std::uint64_t round) {
  Candidate best;
  const auto pick = [&](scene::Random& random) {
    return sights[static_cast<std::size_t>(random.unit() * static_cast<double>(sights.size()))];
  };
  for (int guess = 0; guess < guesses; ++guess) {
    scene::Random random(seed, round * static_cast<std::uint64_t>(guesses) + static_cast<std::uint64_t>(guess));
    const Sight a = pick(random), b = pick(random);
    const Light along{AreaKind::Plane, a.direction};
    best.offer(along, votes(along, sights, least_cosine));
    const auto focus = crossing(a, b);
    if (!focus) continue;
    const Light towards{AreaKind::Point, *focus};
    best.offer(towards, votes(towards, sights, least_cosine));
  }
  refine(best, sights, least_cosine);
  if (best.votes < least_rays) return std::nullopt;
  return best.light;
}

}  // namespace ctu::influence
