// What a visit of a node asks: the box test of its lanes, then the mask test of those that it hit.
#pragma once

#include <cassert>
#include <cstdint>

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/intersect/slab_test.h"

namespace ctu::reference {

class NodeTest {
 public:
  /// `masks` may be null when the tester's design is none. All three must outlive this.
  NodeTest(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester)
      : bvh_(bvh), masks_(masks), tester_(tester), culling_(tester.design() != cull::Design::None) {
    assert(masks != nullptr || !culling_);
  }

  const accel::Bvh4& bvh() const { return bvh_; }
  const cull::MaskTester& tester() const { return tester_; }

  /// The lanes that pass, for a ray whose best hit so far is at `tmax`. Of `times`, t0, t1 and hit are filled, and with
  /// a design that culls all bounds.
  cull::MaskTestResult operator()(const intersect::PreparedRay& ray, std::uint32_t node, float tmax,
                                  intersect::SlabTimes& times) const {
    const intersect::Box4& boxes = bvh_.nodes[node].boxes;
    if (culling_)
      times = intersect::slab_test(ray, boxes, tmax);
    else
      intersect::slab_test_outer(ray, boxes, tmax, times);
    return tester_.test(ray, times, boxes, culling_ ? masks_->of(node) : cull::NodeMasks{});
  }

 private:
  const accel::Bvh4& bvh_;
  const cull::ObjectMasks* masks_;
  const cull::MaskTester& tester_;
  const bool culling_;
};

}  // namespace ctu::reference
