// A trace opened for running: its tree and its masks, and the bytes that a unit with some design fetches.
#pragma once

#include <cstdint>
#include <string>

#include "model/accel/bvh4.h"
#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/cull/options.h"
#include "traces/mask_set.h"
#include "traces/trace_feed.h"
#include "traces/trace_reader.h"

namespace ctu::sim {

class LoadedTrace {
 public:
  /// Error when the file is not a whole and valid trace.
  explicit LoadedTrace(const std::string& path);

  const traces::TraceReader& reader() const { return reader_; }
  const accel::Bvh4& bvh() const { return bvh_; }
  const cull::ObjectMasks& masks() const { return set_.masks; }
  const cull::MaskOptions& mask_options() const { return reader_.manifest().masks; }

  /// The test over the masks of this trace. Error when it has none and the design asks them.
  cull::MaskTester tester(cull::Design design) const;

  /// Nodes carry masks only when the design asks them.
  accel::Image unit_image(cull::Design design) const;

  /// Rays [first, first + count); count 0 means to the end. Error when the trace has no such rays.
  traces::RayRange range(std::uint64_t first, std::uint64_t count) const;

 private:
  traces::TraceReader reader_;
  accel::Bvh4 bvh_;
  traces::MaskSet set_;
};

}  // namespace ctu::sim
