// Reads a scene file of any format we know, or makes a generated scene.
#pragma once

#include <string>

#include "model/scene/scene.h"

namespace ctu::scene {

struct LoadOptions {
  float strand_thickness = 0;  ///< ribbon width in scene units; 0: from the file, or a default by its size
};

/// `name` is a path (.obj .ply .gltf .glb .pbrt .scn .hair .tfx .nff, each also with .zst behind it), or a generator as in
/// "gen:hair-ball?strands=2000&seed=1". Throws Error on anything that is not a scene: file, element, remedy.
/// The result has at least one triangle, all indices in range, all vertices finite.
Scene load(const std::string& name, const LoadOptions& options = {});

}  // namespace ctu::scene
