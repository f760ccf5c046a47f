// intersect::triangle_test made fast without changing a bit of what it answers: the three vertices side by side in
// binary32 wherever that gives the defined results, the defined test itself everywhere else.
#pragma once

#include <emmintrin.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "model/accel/bvh4.h"
#include "model/intersect/sphere_test.h"
#include "model/intersect/triangle_test.h"

namespace ctu::reference {

/// The coordinates of a triangle's vertices by axis. The fourth column of the first row is the id, with an offset that
/// makes its bits a normal number: arithmetic on whole rows would be slow on subnormals.
struct alignas(16) VertexRows {
  float axis[3][4];

  static constexpr std::uint32_t kIdOffset = 0x3f000000u;

  explicit VertexRows(const accel::LeafTriangle& t) {
    for (int a = 0; a < 3; ++a) {
      axis[a][0] = t.v0[a];
      axis[a][1] = t.v1[a];
      axis[a][2] = t.v2[a];
      axis[a][3] = 0;
    }
    axis[0][3] = std::bit_cast<float>(t.primitive + kIdOffset);
  }
  Vec3 vertex(int i) const { return {axis[0][i], axis[1][i], axis[2][i]}; }
  std::uint32_t primitive() const { return std::bit_cast<std::uint32_t>(axis[0][3]) - kIdOffset; }
};

/// Spheres, laid out as in LeafTriangle, by their test, triangles by another class of this file.
template <class Triangle>
class WithSpheres {
 public:
  WithSpheres(const intersect::Ray& ray, const Triangle& triangle)
      : ray_(intersect::prepare_ray(ray)), triangle_(triangle) {}

  intersect::TriangleResult test(const VertexRows& row, float tmax) const {
    if ((row.primitive() & accel::LeafTriangle::kSphereBit) == 0) return triangle_.test(row, tmax);
    const intersect::SphereResult result = intersect::sphere_test(ray_, {row.vertex(0), row.vertex(1).x}, tmax);
    return {result.hit, result.t, 0, 0};
  }

 private:
  intersect::PreparedRay ray_;
  const Triangle& triangle_;
};

/// The defined test and nothing else.
class DefinedTriangle {
 public:
  explicit DefinedTriangle(const intersect::Ray& ray) : ray_(intersect::prepare_ray(ray)) {}

  intersect::TriangleResult test(const VertexRows& t, float tmax) const {
    return intersect::triangle_test(ray_, t.vertex(0), t.vertex(1), t.vertex(2), tmax);
  }

 private:
  intersect::PreparedRay ray_;
};

/// triangle_test keeps 24 bits at any exponent, so binary32 operations equal its own as long as nothing leaves the
/// range of normal numbers. `fits` says for which rays that is so but for the checks made on each triangle.
class FastTriangle {
 public:
  /// To be asked of rays that FastBoxes fit.
  static bool fits(const intersect::Ray& ray, int kz) {
    const float smallest = std::fabs(ray.direction[kz]) * 0x1p-60f;
    for (int axis = 0; axis < 3; ++axis) {
      const float d = std::fabs(ray.direction[axis]);
      if (d != 0 && !(d >= smallest)) return false;
    }
    return true;
  }

  FastTriangle(const intersect::Ray& ray, int kz) : ray_(ray), kz_(kz) {
    kx_ = kz == 2 ? 0 : kz + 1;
    ky_ = kx_ == 2 ? 0 : kx_ + 1;
    if (ray.direction[kz] < 0) std::swap(kx_, ky_);
    dz_ = ray.direction[kz];
    sx_ = _mm_set1_ps(ray.direction[kx_] / dz_);
    sy_ = _mm_set1_ps(ray.direction[ky_] / dz_);
    ox_ = _mm_set1_ps(ray.origin[kx_]);
    oy_ = _mm_set1_ps(ray.origin[ky_]);
    oz_ = _mm_set1_ps(ray.origin[kz]);
  }

  intersect::TriangleResult test(const VertexRows& triangle, float tmax) const {
    const __m128 z = _mm_sub_ps(_mm_load_ps(triangle.axis[kz_]), oz_);
    const __m128 x = _mm_sub_ps(_mm_sub_ps(_mm_load_ps(triangle.axis[kx_]), ox_), _mm_mul_ps(sx_, z));
    const __m128 y = _mm_sub_ps(_mm_sub_ps(_mm_load_ps(triangle.axis[ky_]), oy_), _mm_mul_ps(sy_, z));
    const __m128 x_cab = cab(x), x_bca = bca(x), y_cab = cab(y), y_bca = bca(y);
    // Rounding is monotone: products that differ after it differed the same way before.
    const __m128 p = _mm_mul_ps(x_cab, y_bca), q = _mm_mul_ps(y_cab, x_bca);
    const int negative = _mm_movemask_ps(_mm_cmplt_ps(p, q)) & 7, positive = _mm_movemask_ps(_mm_cmpgt_ps(p, q)) & 7;
    // A tiny z may have lost bits in the products of the shear.
    const __m128 sign = _mm_set1_ps(-0.0f);
    if (_mm_movemask_ps(_mm_cmplt_ps(_mm_andnot_ps(sign, z), _mm_set1_ps(0x1p-60f))) & 7)
      return defined(triangle, tmax);
    if (negative != 0 && positive != 0) return {};
    return finish(x_cab, y_bca, y_cab, x_bca, z, triangle, tmax);
  }

 private:
  static __m128 cab(__m128 v) { return _mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 1, 0, 2)); }
  static __m128 bca(__m128 v) { return _mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1)); }

  [[gnu::noinline, gnu::cold]] intersect::TriangleResult defined(const VertexRows& t, float tmax) const {
    return intersect::triangle_test(intersect::prepare_ray(ray_), t.vertex(0), t.vertex(1), t.vertex(2), tmax);
  }

  /// Whether a difference of exact products, rounded to binary64, rounds to binary32 as the exact one would and stays
  /// in range: not when it sits on the midpoint of two binary32 numbers, where the first rounding may have put it.
  static bool rounds_once(double e) {
    const auto bits = std::bit_cast<std::uint64_t>(e);
    const double size = std::fabs(e);
    return (bits & ((std::uint64_t{1} << 29) - 1)) != std::uint64_t{1} << 28 && size >= 0x1p-60 && size <= 0x1p60;
  }

  intersect::TriangleResult finish(__m128 x_cab, __m128 y_bca, __m128 y_cab, __m128 x_bca, __m128 z,
                                   const VertexRows& triangle, float tmax) const {
    alignas(16) float cx[4], by[4], cy[4], bx[4], depth_of[4];
    _mm_store_ps(cx, x_cab);
    _mm_store_ps(by, y_bca);
    _mm_store_ps(cy, y_cab);
    _mm_store_ps(bx, x_bca);
    _mm_store_ps(depth_of, z);
    double edge[3];
    for (int i = 0; i < 3; ++i) edge[i] = static_cast<double>(cx[i]) * by[i] - static_cast<double>(cy[i]) * bx[i];
    if (!(rounds_once(edge[0]) & rounds_once(edge[1]) & rounds_once(edge[2]))) return defined(triangle, tmax);
    if ((edge[0] < 0) != (edge[1] < 0) || (edge[0] < 0) != (edge[2] < 0)) return {};
    const auto u = static_cast<float>(edge[0]), v = static_cast<float>(edge[1]), w = static_cast<float>(edge[2]);
    const float det = (u + v) + w;
    const float t = ((u * depth_of[0] + v * depth_of[1]) + w * depth_of[2]) / (det * dz_);
    if (!(std::fabs(t) >= 0x1p-120f)) return defined(triangle, tmax);
    if (!(ray_.tmin <= t && t <= tmax)) return {};
    return {true, t, v / det, w / det};
  }

  intersect::Ray ray_;
  int kx_, ky_, kz_;
  float dz_;
  __m128 sx_, sy_, ox_, oy_, oz_;
};

}  // namespace ctu::reference
