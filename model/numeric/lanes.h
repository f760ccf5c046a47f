// The directed operations of round.h on four binary32 lanes at once, branch-free, the same bits in every lane.
//
// Two forms: portable vector arithmetic (each lane as in round.h, binary64 inside), and AVX-512's embedded rounding
// where the target has it. Both exist side by side under namespaces of their own so that tests can hold them equal;
// the unqualified functions are the faster one. No NaN check is dropped: a lane may hold anything.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "model/numeric/round.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define CTU_EMBEDDED_ROUNDING 1
#include <immintrin.h>
#else
#define CTU_EMBEDDED_ROUNDING 0
#endif

namespace ctu::numeric {

typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Mask4 __attribute__((vector_size(16)));  ///< 0 or -1 a lane, as comparisons give

inline Float4 splat(float x) { return Float4{x, x, x, x}; }
inline Mask4 splat(std::int32_t x) { return Mask4{x, x, x, x}; }
inline Mask4 lane_bits(Float4 x) { return std::bit_cast<Mask4>(x); }
inline Float4 from_lane_bits(Mask4 x) { return std::bit_cast<Float4>(x); }

inline Float4 load4(const float* from) {
  Float4 x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void store4(float* to, Float4 x) { std::memcpy(to, &x, sizeof x); }

/// Bit `lane` of the result: the mask is set there.
inline unsigned lane_set(Mask4 mask) {
  const Mask4 weighted = mask & Mask4{1, 2, 4, 8};
  return static_cast<unsigned>(weighted[0] | weighted[1] | weighted[2] | weighted[3]);
}

namespace detail {

inline constexpr std::int32_t kSignBit = std::numeric_limits<std::int32_t>::min();

inline Float4 canonical(Float4 x) {
  return from_lane_bits(x == x ? lane_bits(x) : splat(static_cast<std::int32_t>(kCanonicalNan)));
}

typedef std::uint32_t Bits4 __attribute__((vector_size(16)));  // steps past a NaN's bits must wrap

/// As round.h's neighbours, for the lanes of `where`. A zero counts as the one from which the step leads away, so that
/// every step is one place of the bits.
inline Float4 step_down(Float4 x, Mask4 where) {
  const Mask4 from = x == 0 ? splat(kSignBit) : lane_bits(x);
  const Mask4 place = from < 0 ? splat(1) : splat(-1);
  const Bits4 stepped = std::bit_cast<Bits4>(from) + std::bit_cast<Bits4>(place);
  return from_lane_bits(where ? std::bit_cast<Mask4>(stepped) : lane_bits(x));
}
inline Float4 step_up(Float4 x, Mask4 where) {
  const Mask4 from = x == 0 ? splat(0) : lane_bits(x);
  const Mask4 place = from < 0 ? splat(-1) : splat(1);
  const Bits4 stepped = std::bit_cast<Bits4>(from) + std::bit_cast<Bits4>(place);
  return from_lane_bits(where ? std::bit_cast<Mask4>(stepped) : lane_bits(x));
}

typedef double Wide4 __attribute__((vector_size(32)));
typedef std::int64_t WideMask4 __attribute__((vector_size(32)));

}  // namespace detail

namespace portable {

template <Round M>
inline Float4 add(Float4 a, Float4 b) {
  const Float4 nearest = a + b;
  if constexpr (M == Round::Nearest) {
    return detail::canonical(nearest);
  } else {
    const auto wide_a = __builtin_convertvector(a, detail::Wide4);
    const auto wide_b = __builtin_convertvector(b, detail::Wide4);
    const auto wide_nearest = __builtin_convertvector(nearest, detail::Wide4);
    const auto sum = wide_a + wide_b;
    const auto rest_b = sum - wide_a;
    const auto error = (wide_a - (sum - rest_b)) + (wide_b - rest_b);
    if constexpr (M == Round::Down) {
      const Mask4 below = __builtin_convertvector((sum < wide_nearest) | ((sum == wide_nearest) & (error < 0)), Mask4);
      const Mask4 zero = (lane_bits(a) | lane_bits(b)) & detail::kSignBit;
      const Mask4 stepped = lane_bits(detail::step_down(nearest, below));
      return detail::canonical(from_lane_bits(nearest == 0 ? zero : stepped));
    } else {
      const Mask4 above = __builtin_convertvector((sum > wide_nearest) | ((sum == wide_nearest) & (error > 0)), Mask4);
      return detail::canonical(detail::step_up(nearest, above));
    }
  }
}

template <Round M>
inline Float4 sub(Float4 a, Float4 b) {
  return add<M>(a, from_lane_bits(lane_bits(b) ^ detail::kSignBit));
}

template <Round M>
inline Float4 mul(Float4 a, Float4 b) {
  if constexpr (M == Round::Nearest) {
    return detail::canonical(a * b);
  } else {
    const auto exact = __builtin_convertvector(a, detail::Wide4) * __builtin_convertvector(b, detail::Wide4);
    const Float4 nearest = __builtin_convertvector(exact, Float4);
    const auto wide_nearest = __builtin_convertvector(nearest, detail::Wide4);
    if constexpr (M == Round::Down) {
      const Mask4 below = __builtin_convertvector(exact < wide_nearest, Mask4);
      return detail::canonical(detail::step_down(nearest, below));
    } else {
      const Mask4 above = __builtin_convertvector(exact > wide_nearest, Mask4);
      return detail::canonical(detail::step_up(nearest, above));
    }
  }
}

template <Round M>
inline Float4 div(Float4 a, Float4 b) {
  const Float4 nearest = a / b;
  if constexpr (M == Round::Nearest) {
    return detail::canonical(nearest);
  } else {
    const auto wide_a = __builtin_convertvector(a, detail::Wide4);
    const auto back = __builtin_convertvector(nearest, detail::Wide4) * __builtin_convertvector(b, detail::Wide4);
    const Mask4 remainder_below = __builtin_convertvector(wide_a < back, Mask4);
    const Mask4 remainder_above = __builtin_convertvector(wide_a > back, Mask4);
    if constexpr (M == Round::Down) {
      return detail::canonical(detail::step_down(nearest, b > 0 ? remainder_below : remainder_above));
    } else {
      return detail::canonical(detail::step_up(nearest, b > 0 ? remainder_above : remainder_below));
    }
  }
}

}  // namespace portable

#if CTU_EMBEDDED_ROUNDING
namespace embedded {

template <Round M>
inline constexpr int kMode = (M == Round::Nearest ? _MM_FROUND_TO_NEAREST_INT
                              : M == Round::Down  ? _MM_FROUND_TO_NEG_INF
                                                  : _MM_FROUND_TO_POS_INF) |
                             _MM_FROUND_NO_EXC;

// The masked forms with a full mask are the plain instructions; g++ 12 warns about its own header for the plain ones.
inline constexpr __mmask16 kAll = 0xffff;

inline __m512 widen(Float4 x) { return _mm512_castps128_ps512(std::bit_cast<__m128>(x)); }
inline Float4 narrow(__m512 x) {
  return detail::canonical(std::bit_cast<Float4>(_mm512_maskz_extractf32x4_ps(0xf, x, 0)));
}

template <Round M>
inline Float4 add(Float4 a, Float4 b) {
  return narrow(_mm512_maskz_add_round_ps(kAll, widen(a), widen(b), kMode<M>));
}
template <Round M>
inline Float4 sub(Float4 a, Float4 b) {
  return narrow(_mm512_maskz_sub_round_ps(kAll, widen(a), widen(b), kMode<M>));
}
template <Round M>
inline Float4 mul(Float4 a, Float4 b) {
  return narrow(_mm512_maskz_mul_round_ps(kAll, widen(a), widen(b), kMode<M>));
}
template <Round M>
inline Float4 div(Float4 a, Float4 b) {
  return narrow(_mm512_maskz_div_round_ps(kAll, widen(a), widen(b), kMode<M>));
}

}  // namespace embedded
namespace fastest = embedded;
#else
namespace fastest = portable;
#endif

template <Round M>
inline Float4 add(Float4 a, Float4 b) {
  return fastest::add<M>(a, b);
}
template <Round M>
inline Float4 sub(Float4 a, Float4 b) {
  return fastest::sub<M>(a, b);
}
template <Round M>
inline Float4 mul(Float4 a, Float4 b) {
  return fastest::mul<M>(a, b);
}
template <Round M>
inline Float4 div(Float4 a, Float4 b) {
  return fastest::div<M>(a, b);
}

/// With both orders of the operands, equal lanes differ in the sign of a zero at most: -0 orders before +0.
inline Float4 min(Float4 a, Float4 b) {
  const Mask4 lower = lane_bits(a < b ? a : b) | lane_bits(b < a ? b : a);
  const Mask4 ordered = b == b ? (a == a ? lower : lane_bits(b)) : lane_bits(a);
  return detail::canonical(from_lane_bits(ordered));
}
inline Float4 max(Float4 a, Float4 b) {
  const Mask4 upper = lane_bits(a > b ? a : b) & lane_bits(b > a ? b : a);
  const Mask4 ordered = b == b ? (a == a ? upper : lane_bits(b)) : lane_bits(a);
  return detail::canonical(from_lane_bits(ordered));
}

}  // namespace ctu::numeric
