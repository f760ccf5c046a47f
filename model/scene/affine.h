// Affine maps in binary64: scene files compose many of them, and only the final vertex is rounded to binary32.
#pragma once

#include <array>
#include <optional>

#include "model/numeric/vec3.h"
#include "model/scene/vector64.h"

namespace ctu::scene {

struct Affine {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};  ///< rows; the last column is the translation
  bool operator==(const Affine&) const = default;

  Vector64 point(const Vector64& p) const;
  Vector64 direction(const Vector64& d) const;  ///< without the translation
  /// The image of a vertex, computed in binary64 and rounded once.
  Vec3 vertex(const Vec3& v) const { return point(Vector64(v)).rounded(); }
};

/// First `b`, then `a`.
Affine operator*(const Affine& a, const Affine& b);
/// Nothing if the map is singular.
std::optional<Affine> inverse(const Affine& a);

Affine translation(const Vector64& t);
Affine scaling(const Vector64& s);
/// About an axis through the origin, right-handed; nothing if the axis is zero.
std::optional<Affine> rotation(double degrees, const Vector64& axis);
/// From the quaternion x y z w, not necessarily of length one; nothing if it is zero.
std::optional<Affine> rotation(const std::array<double, 4>& quaternion);
/// From 16 numbers, column by column; nothing if its last row is not 0 0 0 1 (a projection).
std::optional<Affine> from_columns(const std::array<double, 16>& numbers);

}  // namespace ctu::scene
