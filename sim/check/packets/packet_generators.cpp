#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/check/generators/stage.h"
#include "sim/check/packets/packet_case.h"

namespace ctu::sim::check {
namespace {

using intersect::Ray;
using scene::Vector64;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kFirstGenerator = 0x1000;  ///< apart from those of scenes

/// Everything is drawn in units of a frame, as in stage.h: whole numbers in half of the cases, so that rays, faces and
/// edges touch exactly, any numbers in the others.
class PacketStage {
 public:
  PacketStage(CaseRandom& random, PacketCase& out) : random_(random), out_(out), whole_(random.chance(0.5)) {
    frame_ = Frame::scaled(random.chance(0.2) ? random.pick(-40, 40) : 0);
    const double far = random.chance(0.3) ? std::ldexp(1.0, random.pick(4, 20)) : 0;
    for (double& offset : frame_.offset) offset = random.either_sign(far);
    // Most packets have few rays, so that some miss what is near.
    count_ =
        static_cast<std::size_t>(std::clamp(std::llround(std::ldexp(4.0, random.below(5)) * random.unit()), 4ll, 64ll));
  }

  CaseRandom& random() { return random_; }
  std::size_t count() const { return count_; }

  double number(double most) {
    return whole_ ? random_.pick(-static_cast<int>(most), static_cast<int>(most)) : random_.between(-most, most);
  }
  Vector64 vector(double most) {
    return each_axis([&] { return number(most); });
  }
  /// How wide something spreads: from nothing to a few units.
  double spread() { return whole_ ? random_.pick(0, 3) : std::ldexp(random_.unit(), random_.pick(-12, 2)); }
  Vector64 nearby(const Vector64& centre, double spread) { return centre + vector(1) * spread; }

  /// From one point through another, at a t that is a power of two.
  void ray(const Vector64& from, const Vector64& through) {
    const Vec3 o = frame_.point(from), p = frame_.point(through);
    const int exponent = random_.chance(0.5) ? 0 : random_.pick(-3, 3);
    Vec3 d;
    for (int a = 0; a < 3; ++a) d[a] = to_finite(std::ldexp(static_cast<double>(p[a]) - o[a], exponent));
    add(o, d, to_finite(std::ldexp(1.0, -exponent)));
    passed_.push_back(through);
  }

  /// In a direction that is given as it is.
  void ray_along(const Vector64& from, const Vector64& direction, double time) {
    Vec3 d = direction.rounded();
    for (int a = 0; a < 3; ++a) d[a] = to_finite(std::ldexp(static_cast<double>(d[a]), frame_.exponent[0]));
    add(frame_.point(from), d, to_finite(time));
    passed_.push_back(from + direction * time);
  }

  /// The primitives, each beside a point that some ray passes, and how far rays may still reach.
  void finish() {
    const Vector64 a = beside_a_ray(), b = a + vector(4);
    for (int axis = 0; axis < 3; ++axis) {
      const float x = frame_.point(a)[axis], y = random_.chance(0.1) ? x : frame_.point(b)[axis];
      out_.box.lo[axis] = std::min(x, y);
      out_.box.hi[axis] = std::max(x, y);
    }
    const Vector64 corner = beside_a_ray();
    const Vector64 corners[3] = {corner, corner + vector(4), corner + vector(4)};
    const Vector64 motion = vector(4) * 4.0;
    const Vector64 start = beside_a_ray();
    for (int i = 0; i < 3; ++i) {
      out_.triangle.vertex[i] = frame_.point(corners[i]);
      const Vector64 vertex = start + (corners[i] - corner);
      out_.moving.start.vertex[i] = frame_.point(vertex);
      out_.moving.end.vertex[i] = frame_.point(vertex + motion + (random_.chance(0.5) ? vector(2) * 4.0 : Vector64{}));
    }
    draw_sphere();
    for (const Ray& ray : out_.rays) out_.limits.push_back(limit_of(ray));
  }

 private:
  void add(const Vec3& origin, const Vec3& direction, float time) {
    Ray ray;
    ray.origin = origin;
    for (int a = 0; a < 3; ++a)
      ray.direction[a] = direction[a] == 0 ? static_cast<float>(random_.either_sign(0.0)) : direction[a];
    if (ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0) ray.direction.x = 1;
    ray.tmin = 0, ray.tmax = kInfinity;
    if (out_.rays.empty()) mix_ = random_.below(6);
    switch (mix_) {
      case 0:
        ray.tmax = moved_by_ulps(time, random_.pick(-1, 1));
        break;
      case 1:
        ray.tmin = to_finite(time * random_.between(0, 1.2));
        break;
      case 2:
        ray.tmin = to_finite(time * random_.between(-2, 1));
        ray.tmax = std::max(ray.tmin, to_finite(time * random_.between(0.5, 2)));
        break;
      default:
        break;
    }
    out_.rays.push_back(ray);
  }

  /// A point that a ray passes, moved aside: not at all, by a little, or by as much as packets are wide.
  Vector64 beside_a_ray() {
    const Vector64& at = passed_[static_cast<std::size_t>(random_.below(static_cast<int>(passed_.size())))];
    return random_.chance(0.2) ? at : nearby(at, 2 * spread());
  }

  /// Around a point beside a ray; in whole numbers with radii that reach the point, or nearly.
  void draw_sphere() {
    static constexpr double kTriples[][4] = {{3, 4, 0, 5}, {2, 3, 6, 7}, {1, 2, 2, 3}, {4, 4, 7, 9}, {0, 1, 0, 1}};
    const Vector64 at = beside_a_ray();
    const auto& triple = random_.one_of(kTriples);
    const int turn = random_.below(3);
    Vector64 offset;
    for (int a = 0; a < 3; ++a) axis_of(offset, a) = random_.either_sign(triple[(a + turn) % 3]);
    const double size = random_.chance(0.5) ? 1.0 : std::ldexp(random_.unit(), random_.pick(-4, 1));
    out_.sphere.centre = frame_.point(at + offset * size);
    out_.sphere.radius =
        moved_by_ulps(to_finite(std::ldexp(triple[3] * size, frame_.exponent[0])), random_.pick(-1, 1));
    if (random_.chance(0.3)) out_.sphere.radius *= static_cast<float>(random_.unit());
  }

  float limit_of(const Ray& ray) {
    if (mix_ < 5) return ray.tmax;
    const double whole = std::isfinite(ray.tmax) ? ray.tmax : 2;
    return std::clamp(to_finite(whole * random_.unit()), ray.tmin, ray.tmax);
  }

  CaseRandom& random_;
  PacketCase& out_;
  const bool whole_;
  Frame frame_;
  std::size_t count_ = 0;
  int mix_ = 0;  ///< which ranges of t the packet's rays have
  std::vector<Vector64> passed_;
};

/// A pinhole camera: one origin, a window of targets.
void make_shared_origin(CaseRandom& random, PacketCase& out) {
  PacketStage stage(random, out);
  const Vector64 eye = stage.vector(16), target = stage.vector(8);
  const double spread = stage.spread();
  for (std::size_t i = 0; i < stage.count(); ++i) stage.ray(eye, stage.nearby(target, spread));
  stage.finish();
}

/// Bounces from a patch of a surface, into the hemisphere over it.
void make_diffuse(CaseRandom& random, PacketCase& out) {
  PacketStage stage(random, out);
  const Vector64 patch = stage.vector(8), normal = random.direction();
  const double spread = stage.spread();
  for (std::size_t i = 0; i < stage.count(); ++i) {
    const Vector64 direction = scene::normalized(normal + random.direction(), normal);
    stage.ray_along(stage.nearby(patch, spread), direction, random.between(0, 12));
  }
  stage.finish();
}

/// Directions of both signs on one axis or on all: no major axis for many of them.
void make_opposite_signs(CaseRandom& random, PacketCase& out) {
  PacketStage stage(random, out);
  const Vector64 centre = stage.vector(8), along = random.direction() * 8.0;
  const double spread = stage.spread(), width = stage.spread();
  const bool any = random.chance(0.3);
  for (std::size_t i = 0; i < stage.count(); ++i) {
    const Vector64 from = stage.nearby(centre, spread);
    const Vector64 towards = any ? stage.vector(8) : along * random.either_sign(1.0);
    stage.ray(from, stage.nearby(any ? towards : from + towards, width));
  }
  stage.finish();
}

/// Components that are zero, of either sign, in all rays or in most.
void make_axis_parallel(CaseRandom& random, PacketCase& out) {
  PacketStage stage(random, out);
  const Vector64 centre = stage.vector(8);
  const double spread = stage.spread();
  const int axis = random.below(3);
  const double stray = random.chance(0.3) ? 0.2 : 0;  // rays that are not parallel
  const bool both_ways = random.chance(0.3), in_a_plane = random.chance(0.5);
  for (std::size_t i = 0; i < stage.count(); ++i) {
    const Vector64 from = stage.nearby(centre, spread);
    Vector64 step;
    axis_of(step, axis) = both_ways ? random.either_sign(8) : 8;
    if (in_a_plane) axis_of(step, (axis + 1) % 3) = stage.number(4);
    if (random.chance(stray)) step = step + stage.vector(1);
    stage.ray(from, from + step);
  }
  stage.finish();
}

/// Shadow rays: from a patch to one light.
void make_converging(CaseRandom& random, PacketCase& out) {
  PacketStage stage(random, out);
  const Vector64 light = stage.vector(16), patch = stage.vector(8);
  const double spread = stage.spread();
  for (std::size_t i = 0; i < stage.count(); ++i) stage.ray(stage.nearby(patch, spread), light);
  stage.finish();
}

/// Nearly parallel rays from a lens or a patch: no shared origin, but a narrow volume.
void make_coherent(CaseRandom& random, PacketCase& out) {
  PacketStage stage(random, out);
  const Vector64 eye = stage.vector(16), target = stage.vector(8);
  const double lens = stage.spread(), window = stage.spread();
  for (std::size_t i = 0; i < stage.count(); ++i) stage.ray(stage.nearby(eye, lens), stage.nearby(target, window));
  stage.finish();
}

constexpr PacketGenerator kGenerators[] = {
    {"shared-origin", "a camera's rays: one origin, a window of targets", make_shared_origin},
    {"diffuse", "bounces from a patch into the hemisphere over it", make_diffuse},
    {"opposite-signs", "directions of both signs on one axis or on all", make_opposite_signs},
    {"axis-parallel", "components that are zero, of either sign", make_axis_parallel},
    {"converging", "shadow rays from a patch to one light", make_converging},
    {"coherent", "nearly parallel rays from a lens or a patch", make_coherent},
};

}  // namespace

std::span<const PacketGenerator> packet_generators() { return kGenerators; }

PacketCase make_packet_case(std::uint64_t seed, std::uint32_t generator, std::uint64_t number) {
  CaseRandom random(seed, kFirstGenerator + generator, number);
  PacketCase out;
  kGenerators[generator].make(random, out);
  return out;
}

}  // namespace ctu::sim::check
