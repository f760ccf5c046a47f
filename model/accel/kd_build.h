// Builds kd-trees by the surface area heuristic, as pbrt does (MacDonald and Booth 1990; Pharr and Humphreys, section
// 4.5): planes at the bounds of primitives on the longest axis, the others where it has none.
#pragma once

#include "model/accel/kd_tree.h"
#include "model/scene/scene.h"

namespace ctu::accel {

/// The defaults are pbrt's, and those of "Ray-Box Culling for Tree Structures" but for the leaf size.
struct KdOptions {
  int max_leaf_primitives = 1;  ///< a node with so many becomes a leaf; a leaf may have more where no plane pays
  int max_depth = 0;            ///< levels of inner nodes, 1 .. kMostKdDepth; 0: default_kd_depth()
  double traversal_cost = 1;    ///< of an inner node, relative to
  double primitive_cost = 80;   ///< ... a primitive's test
  double empty_bonus = 0.5;     ///< share that an empty child takes off a plane's cost, 0 .. 1
  bool clip = false;            ///< split clipping (Havran 2000): boxes of what of a primitive lies in each child
};
inline constexpr int kMostKdDepth = 64;

/// 8 + 1.3 log2(primitives), both rounded to whole numbers: for the paper's scenes the depths of its Table 1.
int default_kd_depth(std::size_t primitives);

/// Throws Error on options out of range and on a mesh that is none.
KdTree build_kd_tree(const scene::Mesh& mesh, const KdOptions& options);

}  // namespace ctu::accel
