#include "sim/ladder/sample_total.h"

#include <algorithm>
#include <cmath>

#include "sim/ladder/student.h"

namespace ctu::ladder {
namespace {

/// Least squares of the values on their first `known` sizes, from the normal equations by Cholesky's factors. A size
/// that the ones before already give has no part in it.
class LeastSquares {
 public:
  LeastSquares(const std::vector<Draw>& draws, std::size_t known) : known_(known) {
    std::array<Sizes, kSizes> products{};
    Sizes right{};
    for (const Draw& draw : draws)
      for (const Measure& m : draw.chunks)
        for (std::size_t i = 0; i < known_; ++i) {
          for (std::size_t j = 0; j <= i; ++j) products[i][j] += m.sizes[i] * m.sizes[j];
          right[i] += m.sizes[i] * m.value;
        }
    factorize(products);
    slopes_ = backward(forward(right));
  }

  const Sizes& slopes() const { return slopes_; }
  /// The slopes that these sizes would add, were the value at their place larger by one.
  Sizes pull(const Sizes& sizes) const { return backward(forward(sizes)); }

 private:
  void factorize(const std::array<Sizes, kSizes>& products) {
    constexpr double kDependent = 1e-9;
    for (std::size_t i = 0; i < known_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        double sum = products[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= factor_[i][k] * factor_[j][k];
        factor_[i][j] = divided(sum, factor_[j][j]);
      }
      double rest = products[i][i];
      for (std::size_t k = 0; k < i; ++k) rest -= factor_[i][k] * factor_[i][k];
      factor_[i][i] = rest > kDependent * products[i][i] ? std::sqrt(rest) : 0;
    }
  }
  Sizes forward(const Sizes& right) const {
    Sizes y{};
    for (std::size_t i = 0; i < known_; ++i) {
      double sum = right[i];
      for (std::size_t k = 0; k < i; ++k) sum -= factor_[i][k] * y[k];
      y[i] = divided(sum, factor_[i][i]);
    }
    return y;
  }
  Sizes backward(const Sizes& y) const {
    Sizes x{};
    for (std::size_t i = known_; i-- > 0;) {
      double sum = y[i];
      for (std::size_t k = i + 1; k < known_; ++k) sum -= factor_[k][i] * x[k];
      x[i] = divided(sum, factor_[i][i]);
    }
    return x;
  }
  static double divided(double a, double b) { return b > 0 ? a / b : 0; }

  std::size_t known_;
  std::array<Sizes, kSizes> factor_{};  // lower triangle
  Sizes slopes_{};
};

double product(const Sizes& a, const Sizes& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kSizes; ++i) sum += a[i] * b[i];
  return sum;
}

/// Half the squares of the differences of neighbours.
struct Differences {
  double squares = 0;
  std::size_t count = 0;

  void add(double step) {
    squares += step * step / 2;
    ++count;
  }
  double mean() const { return count == 0 ? 0 : squares / static_cast<double>(count); }
  double freedom() const { return std::max(1.0, static_cast<double>(count) * 2 / 3); }
};

/// The two stages' shares of a draw's variance.
struct Stages {
  double between = 0, within = 0;
  Differences groups, chunks;
};

Stages stages_of(const Draw& draw, const std::vector<double>& residuals) {
  Stages s;
  std::size_t groups = 0;
  double sum = 0, sum_before = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const bool begins = i == 0 || draw.chunks[i].group != draw.chunks[i - 1].group;
    if (begins) {
      if (groups > 1) s.groups.add(sum - sum_before);
      sum_before = sum;
      sum = 0;
      ++groups;
    }
    // Where every group is in the sample, groups are but strata, and their borders do not matter.
    if (i > 0 && (!begins || draw.share_of_groups == 1)) s.chunks.add(residuals[i] - residuals[i - 1]);
    sum += residuals[i];
  }
  if (groups > 1) s.groups.add(sum - sum_before);
  s.between = static_cast<double>(groups) * (1 - draw.share_of_groups) * s.groups.mean();
  s.within = static_cast<double>(residuals.size()) * draw.share_of_groups * (1 - draw.share_within) * s.chunks.mean();
  return s;
}

}  // namespace

Total estimate_total(const std::vector<Draw>& draws, const Sizes& totals, std::size_t known) {
  constexpr double kHeaviest = 0.9;  // a chunk that alone decides a slope is not judged by the others
  const LeastSquares fit(draws, known);
  Total total;
  double seen = 0, residual_sum = 0, count = 0;
  Sizes seen_sizes{}, pull_sum{};
  for (const Draw& draw : draws) {
    std::vector<double>& residuals = total.residuals.emplace_back();
    for (const Measure& m : draw.chunks) {
      const Sizes pull = fit.pull(m.sizes);
      const double leverage = std::min(kHeaviest, product(pull, m.sizes));
      const double residual = (m.value - product(fit.slopes(), m.sizes)) / (1 - leverage);
      residuals.push_back(residual);
      residual_sum += residual;
      seen += m.value;
      count += 1;
      for (std::size_t i = 0; i < kSizes; ++i) {
        seen_sizes[i] += m.sizes[i];
        pull_sum[i] += residual * pull[i];
      }
    }
  }
  total.weight = totals[0] / seen_sizes[0];
  total.value = seen + (total.weight - 1) * residual_sum;
  for (std::size_t i = 0; i < kSizes; ++i)
    total.value += (fit.slopes()[i] - pull_sum[i] / count) * (totals[i] - seen_sizes[i]);
  return total;
}

Spread spread_of_sum(const std::vector<Draw>& draws, const std::vector<std::vector<double>>& residuals) {
  double between = 0, within = 0, doubt = 0;
  Spread spread;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const Stages s = stages_of(draws[d], residuals[d]);
    between += s.between;
    within += s.within;
    doubt += s.between * s.between / s.groups.freedom() + s.within * s.within / s.chunks.freedom();
  }
  spread.variance = between + within;
  if (doubt > 0) spread.freedom = std::max(1.0, spread.variance * spread.variance / doubt);
  return spread;
}

double half_width(const std::vector<Draw>& draws, const Total& total, double confidence) {
  const Spread spread = spread_of_sum(draws, total.residuals);
  return student_t(confidence, spread.freedom) * total.weight * std::sqrt(spread.variance);
}

Ratio estimate_ratio(const std::vector<Draw>& draws, const Total& above, const Total& below, double confidence) {
  Total difference = above;
  const double ratio = above.value / below.value;
  for (std::size_t d = 0; d < draws.size(); ++d)
    for (std::size_t i = 0; i < difference.residuals[d].size(); ++i)
      difference.residuals[d][i] -= ratio * below.residuals[d][i];
  return {ratio, half_width(draws, difference, confidence) / below.value};
}

}  // namespace ctu::ladder
