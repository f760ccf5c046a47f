// The forms of the slab test side by side, so that tests can hold them equal: slab_test and slab_test_outer are the
// fastest of them for the target. `portable` is the defined arithmetic written down; `fused` gets rounding errors from
// binary32 and fused multiply-adds (AVX2); `embedded` rounds in the instruction itself (AVX-512).
#pragma once

#include "model/intersect/slab_test.h"
#include "model/numeric/lanes.h"

#if defined(__AVX2__) && defined(__FMA__)
#define CTU_FUSED_SLAB 1
#else
#define CTU_FUSED_SLAB 0
#endif

namespace ctu::intersect {

#define CTU_SLAB_FORM(form)                                                                    \
  namespace form {                                                                             \
  SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax);                  \
  void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out); \
  }

CTU_SLAB_FORM(portable)
#if CTU_FUSED_SLAB
CTU_SLAB_FORM(fused)
#endif
#if CTU_EMBEDDED_ROUNDING
CTU_SLAB_FORM(embedded)
#endif

#undef CTU_SLAB_FORM

}  // namespace ctu::intersect
