// Builds the 4-wide BVH: binned SAH (Wald 2007) to a binary tree, collapsed to four children
// (Wald, Benthin, Boulos 2008; Dammertz, Hanika, Keller 2008).
#pragma once

#include "model/accel/bvh4.h"
#include "model/scene/scene.h"

namespace ctu::accel {

struct BuildOptions {
  int max_leaf_triangles = 4;  ///< 1 .. kMaxLeafTriangles
  int bins = 16;               ///< 2 .. 64
  float node_cost = 1.0f;      ///< of a 4-wide box test, relative to
  float triangle_cost = 1.0f;  ///< ... a triangle test (the paper's unit counts both as 1)
  int threads = 1;             ///< the tree is the same for any number
};

Bvh4 build(const scene::Mesh& mesh, const BuildOptions& options);

}  // namespace ctu::accel
