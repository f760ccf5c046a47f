// From two children to four: the cut of the binary tree into 4-wide nodes and leaves that costs least by the
// paper's Eq. 1, found bottom-up (the dynamic program of Ylitie, Karras, Laine 2017, section 3.1).
#pragma once

#include <span>

#include "model/accel/binary_tree.h"
#include "model/accel/build.h"

namespace ctu::accel {

/// `triangles` are in leaf order, the order of the refs that `tree` was made of.
Bvh4 collapse(std::span<const BinaryNode> tree, std::vector<LeafTriangle> triangles, const BuildOptions& options);

}  // namespace ctu::accel
