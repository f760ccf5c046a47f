#include "sim/ladder/coverage.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/stopwatch.h"

namespace ctu::ladder {

Coverage measure_coverage(const TraceWork& work, const accel::Image& image, const pipeline::UnitConfig& config,
                          const SampledOptions& options, std::uint64_t repetitions, double truth) {
  Coverage coverage;
  coverage.options = options;
  coverage.repetitions = repetitions;
  const auto count = static_cast<double>(repetitions);
  const auto rays = static_cast<double>(std::min(work.range.last, work.reader.rays()) - work.range.first);
  std::vector<double> seconds;
  SampledOptions one = options;
  for (std::uint64_t i = 0; i < repetitions; ++i, ++one.seed) {
    const sim::Stopwatch wall;
    const Sampled sampled = run_sampled(work, image, config, one);
    seconds.push_back(wall.seconds());
    const double error = 0.5 * (sampled.cycles_low + sampled.cycles_high) / truth - 1;
    coverage.covered += sampled.cycles_low <= truth && truth <= sampled.cycles_high;
    coverage.whole += sampled.whole;
    coverage.bias += error / count;
    coverage.rms += error * error / count;
    coverage.half_width += 0.5 * (sampled.cycles_high - sampled.cycles_low) / truth / count;
    coverage.share += static_cast<double>(sampled.simulated_rays) / rays / count;
  }
  coverage.rms = std::sqrt(coverage.rms);
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  coverage.wall_seconds = *middle;
  return coverage;
}

std::string to_table(const std::vector<Coverage>& coverages, double cycle_seconds, bool markdown) {
  const char* const format = markdown ? "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n"
                                      : "{:<18}{:>13}{:>9}{:>7}{:>10}{:>10}{:>12}{:>11}{:>9}\n";
  std::string text = fmt::format(fmt::runtime(format), "samples", "repetitions", "cover", "whole", "bias", "rms error",
                                 "half width", "rays", "x cycle");
  if (markdown) text += "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Coverage& c : coverages)
    text +=
        fmt::format(fmt::runtime(format),
                    fmt::format("{:g}%, {:g}%", 100 * c.options.error, 100 * c.options.confidence), c.repetitions,
                    fmt::format("{:.1f} %", 100 * static_cast<double>(c.covered) / static_cast<double>(c.repetitions)),
                    c.whole, fmt::format("{:+.2f} %", 100 * c.bias), fmt::format("{:.2f} %", 100 * c.rms),
                    fmt::format("{:.2f} %", 100 * c.half_width), fmt::format("{:.1f} %", 100 * c.share),
                    fmt::format("{:.3g}", cycle_seconds / c.wall_seconds));
  return text;
}

}  // namespace ctu::ladder
