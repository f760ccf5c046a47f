// Masks mirrored on axes, and numbered up to mirroring.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/mask_numbering.h"
#include "model/cull/options.h"

namespace ctu::cull {

/// The mask with cell c at R - 1 - c on each axis of `axes` (bit axis).
std::vector<std::uint64_t> mirrored_mask(const std::uint64_t* mask, int resolution, unsigned axes);

/// Numbers masks alike that are each other's mirror images.
class MirrorNumbering {
 public:
  explicit MirrorNumbering(int resolution) : resolution_(resolution), numbering_(words_per_mask(resolution)) {}
  /// The mask is the numbered one, mirrored on `axes`.
  struct Number {
    std::uint32_t number;
    unsigned axes;
  };
  Number number_of(const std::uint64_t* mask);
  std::uint32_t count() const { return numbering_.count(); }
  /// By number, one behind the other.
  const std::vector<std::uint64_t>& masks() const { return numbering_.masks(); }

 private:
  int resolution_;
  MaskNumbering numbering_;
};

}  // namespace ctu::cull
