// Operations of one event of each stage, as the modules of rtl/ have units for them: a stage's arithmetic is done for
// all four lanes and to the end, whether a lane is empty or a triangle is missed.
#pragma once

#include "sim/energy/energy_table.h"

namespace ctu::energy {

struct Operations {
  int adds = 0, multiplies = 0, divides = 0, roots = 0;
  int differences = 0;  ///< a*b - c*d, rounded once
  int fractions = 0;    ///< products with a constant k/R
  int compares = 0;
  int logic_bits = 0;

  double pj(const EnergyTable& table) const {
    return adds * table.at("operation.add") + multiplies * table.at("operation.multiply") +
           divides * table.at("operation.divide") + roots * table.at("operation.root") +
           differences * table.at("operation.difference") + fractions * table.at("operation.fraction") +
           compares * table.at("operation.compare") + logic_bits * table.at("operation.logic_bit");
  }
};

/// Reciprocals on three axes, down and up at once, and the shear: x, y, z over the longest component.
constexpr Operations ray_setup_operations() { return {.divides = 6, .compares = 3}; }

/// Two planes on each axis, four bounds where a mask test asks for the inner ones; entry, exit and which comes first.
constexpr Operations box_test_operations(bool inner_bounds) {
  const int bounds = inner_bounds ? 4 : 2;
  return {.adds = 4 * 3 * bounds, .multiplies = 4 * 3 * bounds, .compares = 4 * (6 + 6 + 1)};
}
/// A directed addition for each of 24 planes.
constexpr Operations box_decode_operations() { return {.adds = 24}; }

/// Of the R - 1 inner planes of each axis: two bounds, each a sum of two weighted faces.
constexpr Operations plane_operations(int resolution) {
  const int bounds = 3 * (resolution - 1) * 2;
  return {.adds = bounds, .fractions = 2 * bounds};
}
/// Planes, and entry and exit against both bounds of each.
constexpr Operations locate_operations(int ray_resolution) {
  Operations all = plane_operations(ray_resolution);
  all.compares = 3 * (ray_resolution - 1) * 4 + 6;
  return all;
}
/// Planes, each axis' R intervals cut to the ray's, R^2 pairs of them for each two axes, and the AND of three.
constexpr Operations comparator_operations(int resolution) {
  Operations all = plane_operations(resolution);
  all.compares = 3 * 3 * resolution + 3 * 2 * resolution * resolution;
  all.logic_bits = 2 * resolution * resolution * resolution;
  return all;
}

constexpr Operations child_sort_operations() { return {.compares = 5}; }
constexpr Operations stack_entry_operations() { return {.compares = 1}; }

/// The box of a ray's stay in a leaf.
constexpr Operations ray_box_operations() { return {.adds = 6, .multiplies = 6, .compares = 1}; }
constexpr Operations box_overlap_operations() { return {.compares = 6}; }

/// Translation and shear of three vertices, three edge functions, determinant, depth, t, u, v.
constexpr Operations triangle_operations() {
  return {.adds = 9 + 6 + 2 + 2, .multiplies = 6 + 1 + 3, .divides = 3, .differences = 3, .compares = 2};
}
constexpr Operations sphere_operations() {
  return {.adds = 3 + 6 + 3 + 1 + 2, .multiplies = 9 + 3 + 1, .divides = 2, .roots = 1, .compares = 3};
}
constexpr Operations hit_operations() { return {.compares = 1}; }

}  // namespace ctu::energy
