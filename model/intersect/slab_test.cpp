// Why the bounds enclose. Mirror every axis with d < 0 (flip the signs of planes and origin: exact), so that d > 0
// and the lower face is the near one. Let r- <= 1/d <= r+ and let D- <= p - o <= D+ be the difference rounded down
// and up. The lower bound of t = (p - o)/d is D- times r- where D- >= 0 (both factors are lower bounds of numbers not
// negative) and D- times r+ where D- < 0 (the larger magnitude), the product rounded down; the upper bound is the
// mirror image. A zero difference is exact and gives t = +0 whatever the reciprocal, which may be infinite for a
// subnormal d. No other product meets infinity times zero: r- is finite and r+ >= r- > 0. So no NaN occurs.
// t0 and t1 combine lower bounds by max and upper bounds by min: they enclose as well.
#include "model/intersect/slab_test.h"

#include "model/intersect/slab_kernels.h"

namespace ctu::intersect {

#if CTU_EMBEDDED_ROUNDING
namespace fastest = embedded;
#elif CTU_FUSED_SLAB
namespace fastest = fused;
#else
namespace fastest = portable;
#endif

SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax) {
  return fastest::slab_test(ray, boxes, tmax);
}

void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out) {
  fastest::slab_test_outer(ray, boxes, tmax, out);
}

}  // namespace ctu::intersect
