// The node test as it is usually written, for `ctusim check --compare`: a slab test and the paper's Algorithm 1 in
// plain binary32, rounded to nearest, with nothing known of errors; and the same with a fixed padding, the usual
// remedy. Nothing of the unit uses it.
#pragma once

#include <cstdint>

#include "model/accel/bvh4.h"
#include "model/cull/object_masks.h"
#include "model/cull/projection_table.h"
#include "model/intersect/ray.h"

namespace ctu::sim::check {

/// By how much a naive form widens what it computed. Both 0: Algorithm 1 as printed.
struct Padding {
  float times = 0;  ///< entry and exit, by this part of themselves
  float box = 0;    ///< each face, by this part of the box's longest side
};

/// Lanes of a node.
struct LaneSets {
  std::uint8_t hit = 0;   ///< by the box test
  std::uint8_t pass = 0;  ///< ... and not culled
};

class NaiveTest {
 public:
  /// All must outlive this. Ray masks are the table's.
  NaiveTest(const accel::Bvh4& bvh, const cull::ObjectMasks& masks, const cull::ProjectionTable& table, Padding padding)
      : bvh_(bvh), masks_(masks), table_(table), padding_(padding) {}

  LaneSets operator()(const intersect::Ray& ray, std::uint32_t node) const;

 private:
  bool shares_a_cell(cull::CellKey key, std::uint32_t node, int lane) const;

  const accel::Bvh4& bvh_;
  const cull::ObjectMasks& masks_;
  const cull::ProjectionTable& table_;
  Padding padding_;
};

}  // namespace ctu::sim::check
