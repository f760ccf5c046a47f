// The shapes of a .pbrt that are triangles, become triangles, or are spheres.
#pragma once

#include <filesystem>

#include "model/scene/draft.h"
#include "model/scene/pbrt_text.h"

namespace ctu::scene {

/// Appends the shape whose statement "Shape" was just read, with the coordinates that it states: the caller moves them.
/// PLY files are looked for in `folder`. Throws Error for all other shapes.
void append_pbrt_shape(PbrtText& text, const std::filesystem::path& folder, Draft& target);

}  // namespace ctu::scene
