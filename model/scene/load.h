// Reads a scene file of any format we know, or makes a generated scene.
#pragma once

#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace ctu::scene {

inline constexpr int kMostStrandSides = 16;

struct LoadOptions {
  float strand_thickness = 0;  ///< ribbon width in scene units; 0: from the file, or a default by its size
  int strand_sides = 2;        ///< 2: strands are ribbons; 3 to kMostStrandSides: tubes of so many sides
  /// Files that a scene names are left out if their names, without folders, match one of these as in a shell
  /// ("leaf_*").
  std::vector<std::string> without;
};

/// `name` is one of
///  - a path (.obj .ply .gltf .glb .pbrt .scn .hair .tfx .nff, each also with .zst behind it),
///  - several paths joined by commas: one scene of all their triangles, in that order,
///  - a .list: a text file with one such path a line, relative to the list's own folder, where the files named inside
///    are looked for too; "camera NAME.pbrt" takes only the camera of that file; '#' starts a comment,
///  - a generator as in "gen:hair-ball?strands=2000&seed=1" (generate.h).
/// A file that a scene names is looked for in the scene's folder and the one above; one that is not there is an Error
/// unless a MISSING.txt beside the scene lists it.
///
/// Throws Error on anything that is not a scene: file, element, remedy; and on a pattern that left out nothing. The
/// result has at least one triangle or sphere, all indices in range, all vertices and spheres finite. Triangles without
/// area are kept and counted.
Scene load(const std::string& name, const LoadOptions& options = {});

}  // namespace ctu::scene
