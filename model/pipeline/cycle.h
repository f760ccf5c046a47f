// Time in cycles of the unit's one clock.
#pragma once

#include <cstdint>

namespace ctu::pipeline {

using Cycle = std::uint64_t;
inline constexpr Cycle kNever = ~Cycle{0};

inline Cycle earlier(Cycle a, Cycle b) { return a < b ? a : b; }

}  // namespace ctu::pipeline
