// The one arithmetic of the unit (contract 2): binary32 with the rounding direction in the type.
//
// Rules, the same in reference, SystemC and Verilog:
//   subnormals  are operands and results like any other number (no flush to zero)
//   zero        x - x is +0 under Nearest and Up, -0 under Down; signs of products and quotients as IEEE 754
//   infinity    overflow gives the infinity or the largest finite number, as the direction says
//   NaN         every invalid operation gives the one quiet NaN 0x7fc00000; NaN operands give it too
//   min, max    of a NaN and a number: the number; -0 orders before +0
//   comparisons with a NaN are false
// Results equal IEEE 754 in the same rounding direction, bit for bit. Nothing here touches the
// processor's rounding mode: directed results come from the nearest one and its exact error.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace ctu::numeric {

enum class Round : std::uint8_t { Nearest, Down, Up };

inline constexpr std::uint32_t kCanonicalNan = 0x7fc00000u;

inline std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }
inline float from_bits(std::uint32_t b) { return std::bit_cast<float>(b); }

/// The neighbours on the binary32 line: -inf .. -0,+0 .. +inf. next_up(-0) and next_up(+0) are the
/// smallest subnormal; next_up(+inf) is +inf; next_up(-inf) is the lowest finite number.
float next_up(float x);
float next_down(float x);

template <Round M> float add(float a, float b);
template <Round M> float sub(float a, float b);
template <Round M> float mul(float a, float b);
template <Round M> float div(float a, float b);
float min(float a, float b);
float max(float a, float b);

}  // namespace ctu::numeric
