// The builder with a heuristic of one's own. build() is this with the surface area heuristic and all axes.
#pragma once

#include <memory>
#include <span>

#include "model/accel/binary_tree.h"
#include "model/accel/build.h"

namespace ctu::accel {

/// What the builder works on: the boxes of the triangles, multiplied by a power of two that brings the scene's extent
/// near 1, so that areas neither overflow nor vanish.
struct BuildInput {
  float scale = 1;
  std::unique_ptr<TriangleRef[]> storage;
  std::span<TriangleRef> refs;
};
/// Throws Error on options out of range and on a mesh that is none.
BuildInput build_input(const scene::Mesh& mesh, const BuildOptions& options);

/// The 4-wide tree over a binary one made of the input.
Bvh4 build_output(const scene::Mesh& mesh, const BuildOptions& options, const BuildInput& input,
                  std::span<const BinaryNode> tree);

/// The tree by the SplitHeuristic that `heuristic_at(scale)` is for boxes in coordinates multiplied by `scale`.
template <class HeuristicAt>
Bvh4 build_by(const scene::Mesh& mesh, const BuildOptions& options, const HeuristicAt& heuristic_at) {
  const BuildInput input = build_input(mesh, options);
  const auto heuristic = heuristic_at(input.scale);
  return build_output(mesh, options, input, build_binary_tree(input.refs, options.bins, options.threads, heuristic));
}

}  // namespace ctu::accel
