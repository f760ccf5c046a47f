// Any bytes as a scene: loaded as a user's file is, and what loads is built, masked and laid out.
#pragma once

#include "tests/fuzz/harness.h"

namespace ctu::fuzz {

/// The input as a file of that extension. Beside it lie files of every kind that scenes name, and one that includes it.
void load_scene(const char* extension, Input input);

/// The input behind "gen:". Numbers that would make a large scene are shortened; larger ones, which must be refused,
/// are not.
void load_generated(Input input);

}  // namespace ctu::fuzz
