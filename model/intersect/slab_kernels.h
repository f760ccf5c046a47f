// The forms of the slab test side by side, so that tests can hold them equal: slab_test and slab_test_outer are the
// fastest of them for the target.
#pragma once

#include "model/intersect/slab_test.h"
#include "model/numeric/lanes.h"

namespace ctu::intersect {

namespace portable {
SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax);
void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out);
}  // namespace portable

#if CTU_EMBEDDED_ROUNDING
namespace embedded {
SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax);
void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out);
}  // namespace embedded
#endif

}  // namespace ctu::intersect
