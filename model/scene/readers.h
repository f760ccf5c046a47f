// One reader a format. Each appends the file's triangles to the draft and throws Error with the file and line (text) or
// byte (binary) of what it cannot take. Coordinates are rounded to binary32 as the file states them and, where there
// are transforms, once more after all of them.
#pragma once

#include "model/scene/draft.h"
#include "model/scene/source_file.h"

namespace ctu::scene {

void read_obj(const SourceFile& file, Draft& draft);
void read_ply(const SourceFile& file, Draft& draft);
void read_gltf(const SourceFile& file, Draft& draft);
void read_glb(const SourceFile& file, Draft& draft);
void read_hair(const SourceFile& file, Draft& draft);
void read_tfx(const SourceFile& file, Draft& draft);
void read_nff(const SourceFile& file, Draft& draft);
void read_luxcore(const SourceFile& file, Draft& draft);
void read_pbrt(const SourceFile& file, Draft& draft);

/// A PLY as a part of another scene: read_ply() without noting the format.
void append_ply(const SourceFile& file, Draft& draft);
/// Only the camera that a .pbrt states before its WorldBegin.
void read_pbrt_camera(const SourceFile& file, Draft& draft);

}  // namespace ctu::scene
