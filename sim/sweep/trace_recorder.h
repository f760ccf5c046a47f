// The traces that a space records for itself.
#pragma once

#include <functional>
#include <vector>

#include "sim/sweep/folder.h"
#include "sim/sweep/space.h"

namespace ctu::sweep {

/// Records into the folder what it does not hold yet, or holds as another recording, and reads what the traces say of
/// themselves: one for each of the space's traces. Throws Error with what `ctusim record` said when one cannot be
/// recorded. Nothing when it was told to stop.
std::vector<TraceFacts> ready_traces(const Space& space, const SweepFolder& folder, const std::function<bool()>& stop);

}  // namespace ctu::sweep
