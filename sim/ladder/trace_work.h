// What the estimate and the sample work on: some rays of a trace, and what a design makes of them.
#pragma once

#include <functional>

#include "model/accel/bvh4.h"
#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "traces/trace_feed.h"
#include "traces/trace_reader.h"

namespace ctu::ladder {

/// All must outlive it. `masks` may be null for Design::None. `range` lies within the trace and is not empty.
struct TraceWork {
  const traces::TraceReader& reader;
  const accel::Bvh4& bvh;
  const cull::ObjectMasks* masks;
  const cull::MaskTester& tester;
  traces::RayRange range;
};

}  // namespace ctu::ladder
