// The identity of a trace: equal for equal content, whatever the compressor, the program's version or the file's name.
#pragma once

#include <string>
#include <vector>

#include "traces/file.h"
#include "traces/manifest.h"

namespace ctu::traces {

/// 32 hexadecimal digits (XXH3-128) over the manifest's identity, the columns' names and types, and the checksum of
/// every column of every block.
std::string trace_hash(const Manifest& manifest, const std::vector<IndexEntry>& index);

}  // namespace ctu::traces
