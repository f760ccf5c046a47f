#include "sim/check/brute_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "model/intersect/triangle_test.h"
#include "model/numeric/round.h"

namespace ctu::sim::check {
namespace {

constexpr std::size_t kVector = 8;

/// What tells triangles apart; -0 and 0 are two.
std::array<std::uint32_t, 9> bits_of(const accel::LeafTriangle& t) {
  std::array<std::uint32_t, 9> bits;
  std::size_t i = 0;
  for (const Vec3* v : {&t.v0, &t.v1, &t.v2})
    for (int axis = 0; axis < 3; ++axis) bits[i++] = numeric::bits((*v)[axis]);
  return bits;
}

/// The ray's line in the form of the triangle test's shear, in binary64.
struct Shear {
  int x, y, z;
  double sx, sy;

  explicit Shear(const intersect::PreparedRay& ray) : x(ray.kx), y(ray.ky), z(ray.kz) {
    const Vec3& d = ray.ray.direction;
    sx = static_cast<double>(d[x]) / d[z];
    sy = static_cast<double>(d[y]) / d[z];
  }
};

/// Vertices relative to the line, of triangles side by side. With D the largest |v - o| of a triangle on any axis and
/// u = 2^-24, the triangle test's sheared coordinates are off by at most 6.1 u D (padded_boxes.h) and of size 2 D, so
/// its edge functions differ from the exact ones by at most 50 u D^2; binary64's own errors are nothing against it. So
/// where two edge functions are beyond 2^-17 D^2 = 128 u D^2 to either side, neither the exact ray nor the test meets.
void edge_distances(const double* const (&x)[3], const double* const (&y)[3], const double* const (&z)[3],
                    const double (&origin)[3], double sx, double sy, std::size_t count, double* __restrict distance) {
  const auto larger = [](double a, double b) { return a > b ? a : b; };
  const auto smaller = [](double a, double b) { return a < b ? a : b; };
  for (std::size_t i = 0; i < count; ++i) {
    double px[3], py[3], size = 0;
    for (int v = 0; v < 3; ++v) {
      const double dx = x[v][i] - origin[0], dy = y[v][i] - origin[1], dz = z[v][i] - origin[2];
      size = larger(size, larger(std::fabs(dx), larger(std::fabs(dy), std::fabs(dz))));
      px[v] = dx - sx * dz;
      py[v] = dy - sy * dz;
    }
    const double u = px[2] * py[1] - py[2] * px[1], v = px[0] * py[2] - py[0] * px[2],
                 w = px[1] * py[0] - py[1] * px[0];
    const double most = larger(u, larger(v, w)), least = smaller(u, smaller(v, w));
    distance[i] = smaller(most, -least) - 0x1p-17 * size * size;
  }
}

}  // namespace

BruteForce::BruteForce(const accel::Bvh4& bvh) : bvh_(bvh) {
  group_equal_triangles();
  padded_ = (groups_.size() + kVector - 1) / kVector * kVector;
  distance_.resize(padded_);
  for (int axis = 0; axis < 3; ++axis) {
    coordinate_[axis].resize(3 * padded_);
    for (std::size_t i = 0; i < padded_; ++i) {
      const accel::LeafTriangle& t = bvh.triangles[members_[groups_[std::min(i, groups_.size() - 1)].first]];
      coordinate_[axis][i] = t.v0[axis];
      coordinate_[axis][padded_ + i] = t.v1[axis];
      coordinate_[axis][2 * padded_ + i] = t.v2[axis];
    }
  }
}

void BruteForce::group_equal_triangles() {
  members_.resize(bvh_.triangles.size());
  std::iota(members_.begin(), members_.end(), 0u);
  const auto key = [&](std::uint32_t i) { return bits_of(bvh_.triangles[i]); };
  std::stable_sort(members_.begin(), members_.end(), [&](auto a, auto b) { return key(a) < key(b); });
  for (std::uint32_t i = 0; i < members_.size(); ++i) {
    if (i == 0 || key(members_[i]) != key(members_[i - 1])) groups_.push_back({i, i});
    groups_.back().last = i + 1;
  }
}

const std::vector<Meeting>& BruteForce::meetings(const intersect::PreparedRay& prepared) {
  meetings_.clear();
  const intersect::Ray& ray = prepared.ray;
  const Shear shear(prepared);
  const auto rows = [&](int axis, const double*(&row)[3]) {
    for (std::size_t v = 0; v < 3; ++v) row[v] = coordinate_[axis].data() + v * padded_;
  };
  const double *x[3], *y[3], *z[3];
  rows(shear.x, x);
  rows(shear.y, y);
  rows(shear.z, z);
  const double origin[3] = {ray.origin[shear.x], ray.origin[shear.y], ray.origin[shear.z]};
  edge_distances(x, y, z, origin, shear.sx, shear.sy, padded_, distance_.data());

  oracle::RayOracle exact(ray);
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (distance_[i] > 0) continue;
    const Group& group = groups_[i];
    const accel::LeafTriangle& t = bvh_.triangles[members_[group.first]];
    const auto result = intersect::triangle_test(prepared, t.v0, t.v1, t.v2, ray.tmax);
    const bool met = exact.meets_triangle(t.v0, t.v1, t.v2);
    if (!met && !result.hit) continue;
    for (std::uint32_t m = group.first; m < group.last; ++m)
      meetings_.push_back({members_[m], met, result.hit, result.t});
  }
  counts_ += exact.counts();
  return meetings_;
}

}  // namespace ctu::sim::check
