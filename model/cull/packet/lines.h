// A packet's rays made comparable: origins relative to a point among them, so that little cancels in a scene far from
// zero, and directions of one length, so that "their t" means nearly the same for all.
//
// A ray o + t d becomes (o - reference) + t' (d / scale), t' = scale t, where the scale is a binary32 number and all
// else is enclosed. Sections 3.3 (equal lengths) and 4.1.1 (major axis) of the packet culling paper.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "model/intersect/ray.h"
#include "model/numeric/interval_vector.h"

namespace ctu::cull::packet {

using numeric::Interval;
using numeric::IntervalVector;

enum class Scale : std::uint8_t {
  AsGiven,    ///< the rays' own t, as in the paper, which wants directions of length 1
  MajorAxis,  ///< every ray advances by 1 along the major axis; without one, by at least 1 and less than 2 along some
              ///< axis
};

struct Line {
  IntervalVector origin, direction;
  Interval first, last;  ///< where it begins and ends, in t'; the bounds of `last` may both be +inf
  float scale = 1;
};

/// How far the rays may still reach, where hits have shortened them: upper bounds over all rays asked about.
struct Reach {
  float time = std::numeric_limits<float>::infinity();     ///< in t'
  float forward = std::numeric_limits<float>::infinity();  ///< coordinate along the major axis, in its direction

  static Reach none() { return {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}; }
};

struct Lines {
  std::vector<Line> lines;
  Vec3 reference;
  bool shared_origin = false;
  int axis = -1;          ///< along which all directions have one sign, the one they keep to best; -1: there is none
  bool backward = false;  ///< the sign is negative

  IntervalVector relative(const Vec3& point) const { return numeric::difference(point, reference); }
  /// A coordinate along the major axis, growing where the rays go.
  Interval forward(const IntervalVector& point) const { return backward ? -point[axis] : point[axis]; }
  /// Extends `reach` to where line `i` is at `t`, in the ray's own parameter.
  void extend(Reach& reach, std::size_t i, float t) const;
};

/// All rays must be valid, and there must be one.
Lines make_lines(std::span<const intersect::Ray> rays, Scale scale);

}  // namespace ctu::cull::packet
