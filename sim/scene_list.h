// The scenes that results are made for: the generated ones, and those that an index file names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "sim/commands.h"

namespace ctu::sim {

struct ListedScene {
  std::string name;   ///< short, as tables show it
  std::string path;   ///< what scene::load takes
  bool named = true;  ///< by the user, one by one: what cannot be loaded is an Error, otherwise it is left out
};

/// The scenes that `args.scenes` names: names of `args.index`, files, or generated ones. When it names none, the
/// generated ones and all of the index. An index has a line "NAME PATH" for each scene, paths relative to its folder.
/// Throws Error when neither names a scene and when the index cannot be read.
std::vector<ListedScene> listed_scenes(const SceneArgs& args);

/// `args` with the index of `./dev scenes`, build/scenes/index.txt, if it names none and that is there.
SceneArgs with_default_index(SceneArgs args);

/// `args` with `wanted` for its scenes if it names none: generated ones, and of the index those that it lists.
SceneArgs with_default_scenes(SceneArgs args, const std::vector<std::string>& wanted);

/// `args` with the view of a scene that has an inside worth seeing but no camera in its file, unless `args` has a view.
SceneArgs with_view(const SceneArgs& args, const ListedScene& listed);

/// What a command can trace: some arithmetic is of triangles alone.
enum class Primitives : std::uint8_t { All, Triangles };

/// Throws Error, naming the scene, when it has spheres.
void require_triangles(const scene::Scene& scene);

/// Loads the scene with its view. Nothing, and a line on stderr, when it cannot be loaded, or has other primitives than
/// those, and nobody named it.
std::optional<scene::Scene> load_listed(const SceneArgs& args, const ListedScene& listed,
                                        Primitives primitives = Primitives::All);

/// "a/bunny/bunny.ply.zst" -> "bunny"; "a/kitchen/scene.pbrt" -> "kitchen".
std::string short_name(const std::string& path);

}  // namespace ctu::sim
