// Object masks replaced by entries of a compression LUT (paper 3.2.2 and 3.2.3).
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/compression_lut.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

struct CompressedMasks {
  CompressionLut lut;
  /// Of every child its entry's bits, and in `index` its entry; empty lanes are zero in both.
  ObjectMasks masks;
};

/// Chooses `options.entries` entries as `options.selection` says and replaces every mask by the tightest entry that
/// holds it. The same for any number of threads.
CompressedMasks compress(const accel::Bvh4& bvh, const ObjectMasks& masks, const MaskOptions& options, int threads);

}  // namespace ctu::cull
