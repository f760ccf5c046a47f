// What must hold of a glTF before the library that reads it may see it: it recurses into nested values, reads eight
// bytes beyond a chunk that claims to fill its file, and gives every buffer of a GLB a copy of the one chunk.
#pragma once

#include "model/scene/source_file.h"

namespace ctu::scene {

/// Throws Error, with file and byte, on JSON that is no JSON or is nested too deep, on chunks that do not fit the file,
/// and on buffers that would take many times the file's size.
void check_gltf(const SourceFile& file);
void check_glb(const SourceFile& file);

}  // namespace ctu::scene
