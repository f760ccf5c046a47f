// The tests of model/intersect compiled with several sets of flags. Outside of the namespace `ctu`, which each renames.
#pragma once

#include <cstddef>
#include <cstdint>

/// Per case: ray (origin, direction, tmin, tmax), four boxes (lo, hi as in Box4), three vertices.
inline constexpr std::size_t kNumbersPerCase = 8 + 24 + 9;
/// Per case: the slab test's 4 x 12 bounds, t0, t1, hit; the triangle test's hit, t, u, v.
inline constexpr std::size_t kResultsPerCase = 48 + 8 + 1 + 4;

using IntersectKernel = void(const float* numbers, std::size_t cases, std::uint32_t* out);

IntersectKernel intersect_kernel_o0, intersect_kernel_o3, intersect_kernel_o3_native;
