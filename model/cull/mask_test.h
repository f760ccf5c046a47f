// The question behind the box test, for any design: may the ray touch an occupied cell of this child?
#pragma once

#include <cstdint>
#include <memory>

#include "model/accel/bvh4.h"
#include "model/cull/bit_table.h"
#include "model/cull/cell_locate.h"
#include "model/cull/comparators.h"
#include "model/cull/compression_lut.h"
#include "model/cull/dedup_table.h"
#include "model/cull/ideal.h"
#include "model/cull/object_masks.h"
#include "model/cull/projection_table.h"
#include "model/cull/ray_mask_table.h"

namespace ctu::cull {

/// Lanes (bits) whose object mask is full. They pass unasked in every design but None: no cell is located and no table
/// read for them. `masks.bits` of R^3 bits a lane, words_per_mask(R) words apart.
unsigned full_lanes(const std::uint64_t* object_masks, int resolution);

/// The answers for the four lanes of a node.
struct MaskTestResult {
  std::uint8_t pass = 0;                      ///< bit lane: hit by the slab test and not culled
  std::uint8_t uncertain = 0;                 ///< bit lane: passed because rounding left two candidate cells
  std::uint32_t key[intersect::kLanes] = {};  ///< packed CellKey of hit lanes, for designs that read tables; 0
                                              ///< for a lane whose object mask is full: it passes unasked
};

/// The tables of one design, built once and shared read-only by threads, and the test over them.
class MaskTester {
 public:
  /// `lut`: what the object masks are compressed with, or null. Throws Error, before any work, when the design needs it
  /// and it is not there or of another R, and when a table would be too large.
  MaskTester(Design design, const MaskOptions& options, std::shared_ptr<const CompressionLut> lut = nullptr);
  ~MaskTester();
  MaskTester(MaskTester&&) noexcept;
  MaskTester& operator=(MaskTester&&) noexcept;

  Design design() const;
  const MaskOptions& options() const;

  /// `times` from slab_test (slab_test_outer is enough for Design::None). Lanes that the slab test missed are not
  /// asked; of those it hit, lanes with a full mask pass unasked. `masks` needs `index` for BitTable, and for Dedup
  /// when there is a LUT.
  MaskTestResult test(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                      const intersect::Box4& boxes, const NodeMasks& masks) const;

  /// The tables, for the unit's stages; null where the design has none.
  const RayMaskTable* ray_mask_table() const;
  const ProjectionTable* projection_table() const;
  const BitTable* bit_table() const;
  const DedupTable* dedup_table() const;
  const CompressionLut* compression_lut() const;

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace ctu::cull
