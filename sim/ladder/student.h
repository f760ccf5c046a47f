// Student's distribution, for the width of an interval from few values.
#pragma once

namespace ctu::ladder {

/// t such that |T| <= t with probability `confidence` (0..1) for `freedom` >= 1 degrees of freedom: by bisection of the
/// distribution function, to six digits.
double student_t(double confidence, double freedom);

}  // namespace ctu::ladder
