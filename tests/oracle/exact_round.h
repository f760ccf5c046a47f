// Binary32 operations by rational arithmetic: what IEEE 754 says they are, without using the processor's own.
#pragma once

#include <cstdint>

#include "model/numeric/round.h"

namespace ctu::oracle {

enum class Operation : std::uint8_t { Add, Sub, Mul, Div };

/// The result of the operation on exact rationals, rounded once; special operands by the rules of round.h.
float exact_operation(Operation operation, numeric::Round round, float a, float b);

}  // namespace ctu::oracle
