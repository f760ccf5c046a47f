// Any bytes as a trace, and any changes to a trace that is written with right checksums: read whole, cut, and run.
#pragma once

#include "tests/fuzz/harness.h"

namespace ctu::fuzz {

/// The input as a file. Where it has a footer and frames, their checksums are made those of what they hold, so that
/// damage gets past them.
void read_trace_file(Input input);

/// The first byte picks one of a few traces; every eight bytes behind it are one change of a column's element, a
/// column's length, a field of the index or a word of the manifest.
void read_changed_trace(Input input);

/// The input as the text of a manifest.
void read_manifest(Input input);

}  // namespace ctu::fuzz
