// One reader a format. Each appends the file's triangles to the draft, rounds every coordinate once to binary32, and
// throws Error with the file and line (text) or byte (binary) of what it cannot take.
#pragma once

#include <string>

#include "model/scene/draft.h"
#include "model/scene/source_file.h"

namespace ctu::scene {

void read_obj(const SourceFile& file, Draft& draft);
void read_ply(const SourceFile& file, Draft& draft);


}  // namespace ctu::scene
