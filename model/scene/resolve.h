// Finds the files that a scene file names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "model/scene/draft.h"

namespace ctu::scene {

/// The file `name` of a scene in `folder`: there, or in the folder above it (parts of a scene are often kept in a
/// folder of their own but name their files from the scene's). Nothing, with a warning, if it is not there but a
/// MISSING.txt beside the scene lists it: such a scene is known to be incomplete; nor if LoadOptions::without names it.
/// Otherwise throws Error at `where`.
std::optional<std::filesystem::path> resolve(const std::filesystem::path& folder, const std::string& name,
                                             const Place& where, Draft& draft);

}  // namespace ctu::scene
