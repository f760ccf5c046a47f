// Rays, boxes and triangles for the culling tests: plain random ones and the ones that break careless arithmetic.
#pragma once

#include <cstdint>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/intersect/slab_test.h"

namespace ctu::test {

/// Where a random case lives.
struct Family {
  const char* name;
  float offset = 1;        ///< distance of the ray's origin from the box, in box sizes; 0: origin inside
  float aspect = 1;        ///< longest side of the box over its shortest
  float scale = 1;         ///< size of the box
  bool lattice = false;    ///< all coordinates are small integers times scale: planes and rays coincide
  bool zero_axes = false;  ///< directions with zero components
  bool flat = false;       ///< boxes flat on one axis
  bool cut = false;        ///< tmin and tmax inside the box's interval
};
const std::vector<Family>& families();

/// The family's name, as the name of a test.
std::string identifier(const Family& family);
void PrintTo(const Family& family, std::ostream* out);

struct RayAndBox {
  intersect::Ray ray;
  Vec3 lo, hi;
};

class CaseMaker {
 public:
  explicit CaseMaker(std::uint64_t seed) : random_(seed) {}

  RayAndBox ray_and_box(const Family& family);

  /// A box of the family.
  void box(const Family& family, Vec3& lo, Vec3& hi);
  /// A ray of the family that starts at the family's distance from the box and aims at the target.
  intersect::Ray ray_to(const Family& family, const Vec3& lo, const Vec3& hi, const Vec3& target);
  /// A triangle in the box: of any shape, also thin, flat, or without area.
  void triangle(const Family& family, const Vec3& lo, const Vec3& hi, Vec3 (&vertices)[3]);
  /// A point in the triangle: inside, on an edge, or a vertex.
  Vec3 point_of(const Vec3 (&vertices)[3]);

  float uniform(float from, float to) { return std::uniform_real_distribution<float>(from, to)(random_); }
  int integer(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

 private:
  Vec3 point_in(const Family& family, const Vec3& lo, const Vec3& hi);
  std::mt19937_64 random_;
};

/// One box in lane 0, the other lanes empty.
intersect::Box4 box_in_lane_0(const Vec3& lo, const Vec3& hi);

void bounds_of(const Vec3* points, int count, Vec3& lo, Vec3& hi);

/// A tree of one leaf in lane 0 of the root.
accel::Bvh4 one_leaf(const std::vector<accel::LeafTriangle>& triangles);

/// The exact bits, as hexadecimal floats, for failure messages.
std::string text(const Vec3& v);
std::string text(const RayAndBox& c);

}  // namespace ctu::test
