#include "sim/ladder/ratio_estimate.h"

#include <algorithm>
#include <cmath>

#include "sim/ladder/student.h"

namespace ctu::ladder {

Ratio estimate_ratio(const std::vector<Drawn>& draws, double confidence) {
  Part sum;
  for (const Drawn& draw : draws)
    for (const Part& part : draw.parts) {
      sum.above += part.above;
      sum.below += part.below;
    }
  Ratio ratio;
  if (sum.below == 0) return ratio;
  ratio.value = sum.above / sum.below;
  double variance = 0, differences = 0;  // of the sum of residuals
  for (const Drawn& draw : draws) {
    const std::size_t count = draw.parts.size();
    if (count < 2) continue;
    const auto residual = [&](std::size_t i) { return draw.parts[i].above - ratio.value * draw.parts[i].below; };
    double squares = 0;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const double step = residual(i) - residual(i + 1);
      squares += step * step;
    }
    const double each = squares / (2.0 * static_cast<double>(count - 1));
    variance += static_cast<double>(count) * each * std::max(0.0, 1 - draw.share);
    differences += static_cast<double>(count - 1);
  }
  ratio.freedom = std::max(1.0, differences * 2 / 3);
  ratio.half_width = student_t(confidence, ratio.freedom) * std::sqrt(variance) / sum.below;
  return ratio;
}

}  // namespace ctu::ladder
