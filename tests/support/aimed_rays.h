// Rays that must cross a closed mesh, aimed where tests of boxes and triangles leak: at vertices and edges, along axes,
// with tiny components, from far away.
#pragma once

#include <cstdint>
#include <random>

#include "model/intersect/ray.h"
#include "tests/support/closed_meshes.h"

namespace ctu::test {

enum class Family { InsideOut, Outside, Far4, Far6, AxisParallel, OneZero, Tiny, Subnormal, Scale1em10, Scale1e10 };
inline constexpr Family kFamilies[] = {Family::InsideOut,    Family::Outside,  Family::Far4, Family::Far6,
                                       Family::AxisParallel, Family::OneZero,  Family::Tiny, Family::Subnormal,
                                       Family::Scale1em10,   Family::Scale1e10};
const char* to_string(Family family);

class AimedRays {
 public:
  AimedRays(const ClosedMesh& closed, std::uint64_t seed) : closed_(closed), random_(seed) {}

  /// Aimed at a vertex or a point of an edge, and passing the middle closely enough to cross the mesh whatever happens.
  intersect::Ray next(Family family);

 private:
  double uniform(double from, double to) { return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  Vec3 surface_point();
  Vec3 near_middle();
  void bend(intersect::Ray& ray, const Vec3& target, Family family, int zero_axis, int long_axis);

  const ClosedMesh& closed_;
  std::mt19937_64 random_;
};

}  // namespace ctu::test
