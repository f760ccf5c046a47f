// The operations of the float units, each with its definition in model/numeric, and a way to ask a unit many at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/numeric/round.h"
#include "tests/numeric/operands.h"

namespace ctu::rtl {

using numeric::Pair;
using numeric::Round;

inline constexpr std::array<Round, 3> kRounds{Round::Nearest, Round::Down, Round::Up};
const char* name_of(Round round);

/// What a unit is asked: `select` is its second function (subtract, max), `defined` the bits that it must give.
struct Operation {
  const char* name;
  bool select;
  bool rounds;  ///< whether the result depends on the direction
  std::uint32_t (*defined)(Round, Pair);
};

extern const Operation kAdd, kSubtract, kMultiply, kDivide, kMin, kMax, kCompare;

/// A float unit under test, without registers.
class FloatUnit {
 public:
  virtual ~FloatUnit() = default;
  /// The unit's bits for each pair, into `results`.
  virtual void answer(const Operation& operation, Round round, const std::vector<Pair>& pairs,
                      std::vector<std::uint32_t>& results) = 0;
};

/// The first pair for which the unit's bits are not the defined ones; `differs` says whether there is one.
struct Verdict {
  bool differs = false;
  Pair pair;
  std::uint32_t is = 0, should = 0;
};
Verdict first_difference(FloatUnit& unit, const Operation& operation, Round round, const std::vector<Pair>& pairs);

/// Exact bits of everything, to repeat the case by hand.
std::string show(const Operation& operation, Round round, const Verdict& verdict);

}  // namespace ctu::rtl
