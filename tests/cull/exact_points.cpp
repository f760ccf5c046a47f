#include "tests/cull/exact_points.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>

namespace ctu::test {
namespace {

mpq_class exact(float x) { return mpq_class(static_cast<double>(x)); }

CellIndex cell_at(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution, const mpq_class& t) {
  CellIndex cell;
  for (int a = 0; a < 3; ++a) {
    if (lo[a] == hi[a]) continue;
    const mpq_class x = exact(ray.origin[a]) + t * exact(ray.direction[a]);
    const mpq_class u = resolution * (x - exact(lo[a])) / (exact(hi[a]) - exact(lo[a]));
    mpz_class floor;
    mpz_fdiv_q(floor.get_mpz_t(), u.get_num_mpz_t(), u.get_den_mpz_t());
    cell.of[a] = floor < 0 ? 0 : floor >= resolution ? resolution - 1 : static_cast<int>(floor.get_si());
  }
  return cell;
}

}  // namespace

CellIndex exact_cell_at(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution, float t) {
  return cell_at(ray, lo, hi, resolution, exact(t));
}

ExactOverlap exact_overlap_cells(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution, float tmin,
                                 float tmax) {
  mpq_class from = exact(tmin), to;
  bool bounded = std::isfinite(tmax);
  if (bounded) to = exact(tmax);
  for (int a = 0; a < 3; ++a) {
    const mpq_class origin = exact(ray.origin[a]), direction = exact(ray.direction[a]);
    if (direction == 0) {
      if (origin < exact(lo[a]) || origin > exact(hi[a])) return {};
      continue;
    }
    mpq_class near = (exact(lo[a]) - origin) / direction, far = (exact(hi[a]) - origin) / direction;
    if (near > far) std::swap(near, far);
    if (near > from) from = near;
    if (!bounded || far < to) to = far;
    bounded = true;
  }
  if (from > to) return {};
  return {true, cell_at(ray, lo, hi, resolution, from), cell_at(ray, lo, hi, resolution, to)};
}

bool holds(cull::CellKey key, const CellIndex& first, const CellIndex& last) {
  bool named = true;
  int long_axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int begin = key.begin(axis), end = key.end(axis);
    named &= begin == first.of[axis] && end == last.of[axis];
    if (!named && (std::min(first.of[axis], last.of[axis]) < std::min(begin, end) ||
                   std::max(first.of[axis], last.of[axis]) > std::max(begin, end)))
      return false;
    long_axes += begin != end;
  }
  return named || long_axes <= 1;
}

}  // namespace ctu::test
