#include "tests/rtl/float/float_operations.h"

#include <cstdio>

namespace ctu::rtl {

namespace {

using numeric::bits;

/// A template over the direction, picked at run time.
template <template <Round> class Function>
std::uint32_t rounded(Round round, Pair pair) {
  switch (round) {
    case Round::Down:
      return bits(Function<Round::Down>::of(pair.first, pair.second));
    case Round::Up:
      return bits(Function<Round::Up>::of(pair.first, pair.second));
    default:
      return bits(Function<Round::Nearest>::of(pair.first, pair.second));
  }
}

template <Round M>
struct Add {
  static float of(float a, float b) { return numeric::add<M>(a, b); }
};
template <Round M>
struct Subtract {
  static float of(float a, float b) { return numeric::sub<M>(a, b); }
};
template <Round M>
struct Multiply {
  static float of(float a, float b) { return numeric::mul<M>(a, b); }
};
template <Round M>
struct Divide {
  static float of(float a, float b) { return numeric::div<M>(a, b); }
};

std::uint32_t smaller(Round, Pair pair) { return bits(numeric::min(pair.first, pair.second)); }
std::uint32_t larger(Round, Pair pair) { return bits(numeric::max(pair.first, pair.second)); }

/// As the unit's three outputs: less, equal, unordered from bit 0 on.
std::uint32_t order(Round, Pair pair) {
  const auto [a, b] = pair;
  const bool unordered = a != a || b != b;
  return static_cast<std::uint32_t>(a < b) | static_cast<std::uint32_t>(a == b) << 1 |
         static_cast<std::uint32_t>(unordered) << 2;
}

}  // namespace

const Operation kAdd{"add", false, true, rounded<Add>};
const Operation kSubtract{"subtract", true, true, rounded<Subtract>};
const Operation kMultiply{"multiply", false, true, rounded<Multiply>};
const Operation kDivide{"divide", false, true, rounded<Divide>};
const Operation kMin{"min", false, false, smaller};
const Operation kMax{"max", true, false, larger};
const Operation kCompare{"compare", false, false, order};

const char* name_of(Round round) {
  return round == Round::Nearest ? "to nearest" : round == Round::Down ? "down" : "up";
}

Verdict first_difference(FloatUnit& unit, const Operation& operation, Round round, const std::vector<Pair>& pairs) {
  std::vector<std::uint32_t> results;
  unit.answer(operation, round, pairs, results);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::uint32_t should = operation.defined(round, pairs[i]);
    if (results[i] != should) return {true, pairs[i], results[i], should};
  }
  return {};
}

std::string show(const Operation& operation, Round round, const Verdict& verdict) {
  char text[160];
  std::snprintf(text, sizeof text, "%s %s of 0x%08x and 0x%08x: the unit gave 0x%08x, defined is 0x%08x",
                operation.name, name_of(round), bits(verdict.pair.first), bits(verdict.pair.second), verdict.is,
                verdict.should);
  return text;
}

}  // namespace ctu::rtl
