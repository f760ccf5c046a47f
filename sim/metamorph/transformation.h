// Maps of a whole scene and its rays that keep what meets what: scaled, moved, axes permuted and mirrored.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"
#include "traces/sampling.h"

namespace ctu::sim::metamorph {

/// What is promised of the answers on the transformed scene.
enum class Kind : std::uint8_t {
  Identity,
  Power,        ///< scaled by a power of two: tree, masks and every event the same, t scaled, bit for bit
  Factor,       ///< scaled by any factor and rounded: a scene of its own
  Translation,  ///< moved and rounded: a scene of its own
  Permutation,  ///< of the axes: the same on the tree carried along, bit for bit; a new tree may split otherwise
  Mirror,       ///< of axes: likewise, but for designs that locate half-open cells
};

/// Coordinate a of an image is sign[a] * factor * (coordinate from[a] of the original) + offset[a], in binary64 and
/// rounded to binary32.
struct Transformation {
  std::string name = "as it is";
  Kind kind = Kind::Identity;
  double factor = 1;
  traces::Vec3d offset;
  std::array<int, 3> from{0, 1, 2};
  std::array<double, 3> sign{1, 1, 1};

  Vec3 point(const Vec3& p) const;
  Vec3 direction(const Vec3& d) const;  ///< neither scaled nor moved: exact
  float time(float t) const { return static_cast<float>(t * factor); }
  intersect::Ray operator()(const intersect::Ray& ray) const;
  scene::Mesh operator()(scene::Mesh mesh) const;
  /// Whether no coordinate is rounded.
  bool is_exact() const { return kind != Kind::Factor && kind != Kind::Translation; }
};

/// Magnitudes of coordinates of a scene and of its rays' origins and ends.
struct Magnitudes {
  double smallest = 0;  ///< of those that are not zero; 0: all are
  double largest = 0;
  double size = 0;  ///< the longest side of the scene's box
};
Magnitudes magnitudes(const scene::Mesh& mesh, const std::vector<intersect::Ray>& rays);

/// Whether the same bits are promised of this ray's answers. Under a scale: if no time of it can overflow at either
/// scale. Where axes change places or sides: if one component of its direction is the largest, since among equal ones
/// the triangle test takes the axis that has the higher number.
bool keeps_bits(const Transformation& transformation, const intersect::Ray& ray, const Magnitudes& scene);

struct TransformationList {
  std::vector<Transformation> transformations;
  std::vector<std::string> left_out;  ///< in words, and why
};

/// Of these kinds, in their order: 2^-40, 2^-1, 2^7 and 2^40, or as near to them as the scene's coordinates stay far
/// enough from both ends of binary32's range for no result of the unit to be subnormal or to overflow; 1/3, 1e-7 and
/// 1e7; moved by 1, 1e3, 1e5 and 1e7 sizes; five permutations; seven mirrors.
TransformationList transformations(const std::vector<Kind>& kinds, const Magnitudes& scene);

/// All six permutations of the axes times all eight mirrors, the identity first.
std::vector<Transformation> axis_symmetries();

}  // namespace ctu::sim::metamorph
