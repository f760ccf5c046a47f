// The kernel that is compiled with several sets of flags. Outside of the namespace `ctu`, which each of them renames.
#pragma once

#include <cstddef>
#include <cstdint>

/// Per operand pair: 4 operations x 3 roundings in scalars, the same in lanes, min and max.
inline constexpr std::size_t kResultsPerPair = 2 * 12 + 2;

/// out[r * count + i] is result r of pair i; count is a multiple of four.
using NumericKernel = void(const float* a, const float* b, std::size_t count, std::uint32_t* out);

NumericKernel numeric_kernel_o0, numeric_kernel_o3, numeric_kernel_o3_native;
