// Any bytes as what a user writes: configuration files, assignments, options, an index of scenes.
#pragma once

#include "tests/fuzz/harness.h"

namespace ctu::fuzz {

/// The input as a TOML file; what is taken must come back from what `config show` prints.
void read_config(Input input);

/// Each line as one --set.
void read_assignments(Input input);

/// Each line as "NAME VALUE", an option of a scene; then rays of a small scene with them.
void read_options(Input input);

/// The input as the file of --index.
void read_index(Input input);

}  // namespace ctu::fuzz
