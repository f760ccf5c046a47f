#include "tests/intersect/flag_kernel.h"

#include <bit>
#include <cstring>

#include "model/intersect/slab_test.h"
#include "model/intersect/triangle_test.h"

namespace {

using namespace ctu::intersect;

Ray ray_of(const float* n) {
  Ray ray;
  ray.origin = {n[0], n[1], n[2]};
  ray.direction = {n[3], n[4], n[5]};
  ray.tmin = n[6];
  ray.tmax = n[7];
  return ray;
}

}  // namespace

void CTU_KERNEL(const float* numbers, std::size_t cases, std::uint32_t* out) {
  for (std::size_t i = 0; i < cases; ++i, numbers += kNumbersPerCase, out += kResultsPerCase) {
    const PreparedRay ray = prepare_ray(ray_of(numbers));
    Box4 boxes;
    std::memcpy(&boxes, numbers + 8, sizeof boxes);
    const SlabTimes times = slab_test(ray, boxes, ray.ray.tmax);
    std::memcpy(out, &times, 56 * sizeof(float));
    out[56] = times.hit;
    const float* v = numbers + 32;
    const TriangleResult r =
        triangle_test(ray, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, ray.ray.tmax);
    out[57] = r.hit;
    out[58] = std::bit_cast<std::uint32_t>(r.t);
    out[59] = std::bit_cast<std::uint32_t>(r.u);
    out[60] = std::bit_cast<std::uint32_t>(r.v);
  }
}
