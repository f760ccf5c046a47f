// What the generators have in common: scenes drawn on a lattice, and rays aimed at exact points of it.
//
// Everything is drawn in lattice units, small integers mostly, and put into space by a power of two for each axis and
// an offset, all of which are exact in binary32: so vertices, cell borders for every R, and rays between them lie where
// they are meant to lie, not a rounding away. A ray from A to B has the direction (B - A) 2^e: it passes B at exactly
// t = 2^-e. What is not on the lattice is rounded once.
#pragma once

#include <vector>

#include "model/scene/vector64.h"
#include "sim/check/hard_case.h"

namespace ctu::sim::check {

using scene::Vector64;

/// Side of a block in lattice units: a multiple of every R from 2 to 8 and of R_ray 10, 12, 14, 15, 16, 20, 24.
inline constexpr int kSide = 1680;

double axis_of(const Vector64& v, int axis);
double& axis_of(Vector64& v, int axis);

/// x, y, z drawn in this order.
template <class Draw>
Vector64 each_axis(Draw&& draw) {
  Vector64 v;
  v.x = draw();
  v.y = draw();
  v.z = draw();
  return v;
}

/// From lattice units to space: x = (u + offset) 2^exponent on each axis.
struct Frame {
  int exponent[3] = {0, 0, 0};
  double offset[3] = {0, 0, 0};

  static Frame scaled(int exponent) { return {{exponent, exponent, exponent}, {0, 0, 0}}; }
  /// Rounded to nearest, beyond binary32 to the largest finite number.
  Vec3 point(const Vector64& u) const;
};

/// Which values a ray's range takes about the time of the point it is aimed at.
enum class RangeMix : std::uint8_t {
  Any,      ///< half of them unbounded, the others of all kinds
  Open,     ///< [0, infinity)
  AtPoint,  ///< tmin = tmax = the point's time
  Ends,     ///< begins or ends at the point, or a unit in the last place to either side
};

/// Arguments are aggregates, because those are made in the order they are written in, whatever the compiler: the order
/// of random numbers must not depend on it.
struct Corners {
  Vector64 a, b, c;
};

/// From `origin` through `target` (lattice units), the direction times 2^exponent.
struct Aim {
  Vector64 origin, target;
  RangeMix mix = RangeMix::Any;
  int exponent = 0;
};

class Stage {
 public:
  Stage(CaseRandom& random, HardCase& out, const Frame& frame = {}) : random_(random), out_(out), frame_(frame) {}

  CaseRandom& random() { return random_; }
  const Frame& frame() const { return frame_; }

  void triangle(const Corners& corners);
  int triangles() const { return static_cast<int>(corners_.size() / 3); }
  /// As drawn, in lattice units.
  const Vector64& corner(int triangle, int i) const { return corners_[static_cast<std::size_t>(3 * triangle + i)]; }

  /// A point of a triangle, any of them, or number `triangle`: a vertex, a point of an edge, or one inside.
  Vector64 vertex();
  Vector64 edge_point();
  Vector64 inner_point();
  Vector64 surface_point();

  /// Each zero component of the direction gets either sign.
  void ray(const Aim& aim);

  /// With a direction given in space as it is. `time`: when it passes what it is aimed at.
  void ray_along(const Vector64& origin, const Vec3& direction, double time, RangeMix mix = RangeMix::Any);

  /// Moves coordinates of the last ray's origin and direction by up to `most` units in the last place.
  void nudge(int most);

 private:
  void set_range(intersect::Ray& ray, double time, RangeMix mix);

  CaseRandom& random_;
  HardCase& out_;
  Frame frame_;
  std::vector<Vector64> corners_;
};

/// x moved by `steps` places on the binary32 line, not past the largest finite number.
float moved_by_ulps(float x, int steps);

/// Nearest binary32 number, at most the largest finite one.
float to_finite(double x);

/// A lattice point of the block at `at` (its lower corner) of `side`: any, or one on a border of its R^3 cells.
Vector64 point_in_block(CaseRandom& random, const Vector64& at, double side = kSide);
Vector64 cell_corner(CaseRandom& random, const Vector64& at, double side = kSide);

/// Blocks of struts and plates: a strut is a thin triangle along a block's diagonal, through the corners of the cells
/// it lies in for every R, so that most cells are empty and the full ones are met at their corners. 1 to 4 triangles a
/// block, the first a strut, so that the block bounds them exactly. Returns the blocks' lower corners.
std::vector<Vector64> add_blocks(Stage& stage, int least, int most);

/// Somewhere outside of the blocks that add_blocks makes, at up to a few times their extent, on the lattice.
Vector64 outside_point(CaseRandom& random);

/// Rays that a scene is asked: enough to share the cost of its tree.
inline constexpr int kRays = 512;

}  // namespace ctu::sim::check
