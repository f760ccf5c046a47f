#include "sim/ladder/ladder_rows.h"

#include <algorithm>

#include <fmt/format.h>

namespace ctu::ladder {
namespace {

std::string percent(double value) { return fmt::format("{:.2f} %", 100 * value); }
std::string interval(const std::optional<double>& half_width) {
  return half_width ? "+-" + percent(*half_width) : std::string();
}

/// As one word of a line of data.
std::string word(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == ',' || c == '\'' || c == '"'; }, '_');
  return name;
}

std::string row(const Rung& rung, double cycle_seconds, bool markdown) {
  const char* const format =
      markdown ? "| {} | {} | {} | {} | {} | {} | {} | {} |\n" : "{:<26}{:>14}{:>11}{:>12}{:>12}{:>12}{:>12}{:>12}\n";
  if (!rung.note.empty()) return fmt::format(fmt::runtime(format), rung.engine, rung.note, "", "", "", "", "", "");
  return fmt::format(fmt::runtime(format), rung.engine, fmt::format("{:.0f}", rung.cycles),
                     fmt::format("{:+.2f} %", 100 * rung.error), interval(rung.half_width), percent(rung.share),
                     fmt::format("{:.4f}", rung.wall_seconds), fmt::format("{:.3g}", rung.cycles / rung.wall_seconds),
                     fmt::format("{:.3g}", cycle_seconds / rung.wall_seconds));
}

}  // namespace

std::string to_table(const Ladder& ladder, bool markdown) {
  std::string text;
  if (markdown)
    text +=
        "| engine | cycles | error | interval | rays simulated | seconds | cycles/s | times faster than cycle |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  else
    text += fmt::format("{:<26}{:>14}{:>11}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "engine", "cycles", "error", "interval",
                        "rays", "seconds", "cycles/s", "x cycle");
  for (const Rung& rung : ladder.rungs) text += row(rung, ladder.cycle_seconds, markdown);
  if (!ladder.coverages.empty()) text += "\n" + to_table(ladder.coverages, ladder.cycle_seconds, markdown);
  if (ladder.comparings.empty()) return text;
  text += markdown ? "\n| cycles of the first, times | engine | interval | seconds |\n| ---: | --- | ---: | ---: |\n"
                   : fmt::format("{:<26}{:>14}{:>11}{:>12}\n", "of the first, by", "ratio", "interval", "seconds");
  for (const Comparing& c : ladder.comparings)
    text += markdown ? fmt::format("| {:.4f} | {} | {} | {:.4f} |\n", c.ratio, c.engine, interval(c.half_width),
                                   c.wall_seconds)
                     : fmt::format("{:<26}{:>14.4f}{:>11}{:>12.4f}\n", c.engine, c.ratio, interval(c.half_width),
                                   c.wall_seconds);
  return text;
}

std::string to_csv(const std::vector<Ladder>& ladders) {
  std::string text = "config,engine,cycles,error_percent,half_width_percent,seconds,share_of_rays\n";
  for (const Ladder& ladder : ladders)
    for (const Rung& rung : ladder.rungs)
      if (rung.note.empty())
        text += fmt::format("{},{},{:.0f},{:.6f},{:.6f},{:.6f},{:.6f}\n", word(ladder.config), rung.engine, rung.cycles,
                            100 * rung.error, 100 * rung.half_width.value_or(0), rung.wall_seconds, rung.share);
  return text;
}

std::string plot_script(const std::vector<Ladder>& ladders, const std::string& title) {
  std::string configs;
  for (const Ladder& ladder : ladders) configs += (configs.empty() ? "" : " ") + word(ladder.config);
  std::string text = fmt::format(R"(set datafile separator ','
set datafile missing NaN
set terminal svg noenhanced size 900,520 font 'sans,13' background 'white'
set output 'ladder.svg'
configs = '{}'
set title '{}: error against run time'
)",
                                 configs, word(title));
  // An answer without error has no place on a logarithmic axis: it is drawn at the lower border.
  text += R"(set logscale xy
set xlabel 'seconds'
set ylabel 'error of the cycles, percent (bars: half the interval)'
set yrange [0.01:100]
set grid lc rgb '#dddddd'
set key outside right top samplen 2
drawn(e) = (abs(e) < 0.012 ? 0.012 : abs(e))
colors = '#1f77b4 #d62728 #2ca02c #9467bd #ff7f0e #8c564b'
plot for [i = 1:words(configs)] 'ladder.csv' skip 1 \
    using (strcol(1) eq word(configs, i) ? $6 : NaN):(drawn($4)) with points pt i + 4 ps 1.4 lc rgb word(colors, (i - 1) % 6 + 1) \
    title word(configs, i), \
  for [i = 1:words(configs)] 'ladder.csv' skip 1 \
    using (strcol(1) eq word(configs, i) && $5 > 0 ? $6 : NaN):(0.012):(0.012):(drawn($5)) with yerrorbars pt 0 lw 1.5 \
    lc rgb word(colors, (i - 1) % 6 + 1) notitle, \
  for [i = 1:words(configs)] 'ladder.csv' skip 1 \
    using (strcol(1) eq word(configs, i) ? $6 : NaN):(drawn($4)):2 with labels left rotate by 30 offset 0.5,0.5 font ',10' notitle
)";
  return text;
}

}  // namespace ctu::ladder
