// Several trees in one: a tree over the whole scene, and behind it trees for some of the rays, each over the primitives
// that these can meet. They share nothing but the arrays they lie in, so one image holds them all, and a ray walks the
// one whose root it begins at.
#pragma once

#include "model/accel/bvh4.h"

namespace ctu::accel {

inline constexpr std::uint32_t kMostTrees = 256;

/// Puts `tree`, which is one tree, behind those of `trees`, as the one with the next number. Bounds of the scene stay
/// those of the first. Throws Error beyond kMostTrees, and when nodes or primitives are more than child references
/// can name.
void append_tree(Bvh4& trees, const Bvh4& tree);

}  // namespace ctu::accel
