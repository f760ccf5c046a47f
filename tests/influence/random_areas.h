// Influence areas, points, triangles and boxes near each other: of every size, turned every way, and on a lattice where
// they touch exactly.
#pragma once

#include <cmath>
#include <random>

#include "model/influence/area.h"

namespace ctu::test {

class AreaRandom {
 public:
  explicit AreaRandom(std::uint64_t seed) : random_(seed) {}

  float between(float low, float high) { return low + (high - low) * unit(); }
  int whole(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }

  /// About `scale` large, around the origin of space, moved by up to `shift`.
  influence::InfluenceArea area(float scale, float shift) {
    influence::InfluenceArea area;
    area.kind = whole(0, 1) == 0 ? influence::AreaKind::Plane : influence::AreaKind::Point;
    area.origin = point(shift);
    area.axes = influence::frame_along(point(1), point(1));
    const bool converges = area.kind == influence::AreaKind::Point;
    area.half_x = between(0.05f, 1) * (converges ? 1 : scale);
    area.half_y = between(0.05f, 1) * (converges ? 1 : scale);
    area.near = whole(0, 3) == 0 ? 0 : between(0, 0.5f) * scale;
    area.far = area.near + between(0.1f, 1.5f) * scale;
    return area;
  }

  /// Aligned with the world, all numbers small and whole: bodies on the same lattice touch exactly.
  influence::InfluenceArea lattice_area() {
    influence::InfluenceArea area;
    area.kind = whole(0, 1) == 0 ? influence::AreaKind::Plane : influence::AreaKind::Point;
    area.origin = lattice_point(3);
    const int first = whole(0, 2);
    area.axes = {};
    for (int i = 0; i < 3; ++i) area.axes[i][(first + i) % 3] = whole(0, 1) == 0 ? 1.0f : -1.0f;
    area.half_x = static_cast<float>(whole(0, 3));
    area.half_y = static_cast<float>(whole(0, 3));
    area.near = static_cast<float>(whole(0, 2));
    area.far = area.near + static_cast<float>(whole(0, 3));
    return area;
  }

  Vec3 point(float reach) { return {between(-reach, reach), between(-reach, reach), between(-reach, reach)}; }
  Vec3 lattice_point(int reach) {
    return {static_cast<float>(whole(-reach, reach)), static_cast<float>(whole(-reach, reach)),
            static_cast<float>(whole(-reach, reach))};
  }

 private:
  float unit() { return static_cast<float>(random_() >> 40) * 0x1p-24f; }
  std::mt19937_64 random_;
};

}  // namespace ctu::test
