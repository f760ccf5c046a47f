#include "sim/paper/subspace_plots.h"

#include <fmt/format.h>

#include "sim/paper/plot.h"

namespace ctu::sim::paper {
namespace {

/// A line for each scene, resolution and L; L = 6 stands for unlimited.
std::string level_data(const std::vector<SceneResult>& results) {
  std::string text = "scene,R,L,intersections_percent,mask_seconds,mask_seconds_relative\n";
  for (const SceneResult& scene : results)
    for (const ResolutionResult& result : scene.at)
      for (std::size_t l = 0; l < result.levels.size(); ++l) {
        const LevelResult& level = result.levels[l];
        const double base = result.levels.front().seconds;
        text += fmt::format("{},{},{},{:.3f},{:.6f},{:.4f}\n", scene.name, result.resolution, l + 1, level.percent,
                            level.seconds, base > 0 ? level.seconds / base : 0);
      }
  return text;
}

/// A line for each scene and resolution, the paper's values behind ours; nan where the paper has none.
std::string ratio_data(const std::vector<SceneResult>& results) {
  std::string text =
      "scene,R,ideal,lut,lut_double,compressed_paper,compressed_summed,compressed_ours,"
      "published_ideal,published_lut,published_lut_double,published_compressed\n";
  for (const SceneResult& scene : results)
    for (std::size_t r = 0; r < kResolutions.size(); ++r) {
      text += fmt::format("{},{}", scene.name, kResolutions[r]);
      for (const Column column : {Column::Ideal, Column::Lut, Column::LutDouble, Column::CompressedPaper,
                                  Column::CompressedSummed, Column::CompressedOurs})
        text += fmt::format(",{:.3f}", scene.at[r].columns[static_cast<std::size_t>(column)].percent);
      const Counterpart paper = counterpart(scene.name);
      if (paper.scene == nullptr) {
        text += ",nan,nan,nan,nan\n";
        continue;
      }
      const PublishedRatios& row = paper.scene->ratios[r];
      text += fmt::format(",{},{},{},{}\n", row.ideal, row.lut, row.lut_double, row.compressed);
    }
  return text;
}

/// The names between quotes and blanks, those with a counterpart in the paper or those without.
std::string names(const std::vector<SceneResult>& results, bool with_counterpart) {
  std::string text;
  for (const SceneResult& scene : results)
    if ((counterpart(scene.name).scene != nullptr) == with_counterpart) text += (text.empty() ? "" : " ") + scene.name;
  return text;
}

constexpr const char* kHead = R"(set datafile separator ','
set datafile missing 'nan'
set terminal svg noenhanced size {},{} font 'sans,13' background 'white'
set output '{}'
)";

std::string level_script(const std::vector<SceneResult>& results) {
  std::string text = fmt::format(kHead, 1200, 900, "fig8.svg");
  text += fmt::format("compared = '{}'\nothers = '{}'\n", names(results, true), names(results, false));
  text += R"(set multiplot layout 2,2 margins 0.06,0.81,0.07,0.90 spacing 0.07,0.14 \
  title 'Fig. 8: object masks from nodes L levels below' font ',16'
set grid ytics lc rgb '#dddddd'
set xrange [0.8:6.2]
set xtics ('1' 1, '2' 2, '3' 3, '4' 4, '5' 5, 'unlimited' 6)
set xlabel 'L, levels'
set key at screen 0.995,0.9 right top samplen 2 font ',11'
array colors[12] = ['#1f77b4','#d62728','#2ca02c','#9467bd','#ff7f0e','#8c564b','#e377c2','#17becf','#bcbd22','#000000','#1a5276','#7d6608']
color(i) = colors[(i - 1) % 12 + 1]
do for [panel = 0:1] {
  do for [r = 4:6:2] {
    set ylabel panel == 0 ? 'intersections, % of no culling' : 'time to make the masks, L = 1 is 1'
    set title sprintf('R = %d', r)
    if (panel == 1 || r == 6) { unset key }
    c = panel == 0 ? 4 : 6
    plot for [i = 1:words(others)] 'fig8.csv' skip 1 using 3:(strcol(1) eq word(others, i) && $2 == r ? column(c) : NaN) \
           with lines lc rgb '#bbbbbb' title (i == 1 ? 'other scenes' : ''), \
         for [i = 1:words(compared)] 'fig8.csv' skip 1 using 3:(strcol(1) eq word(compared, i) && $2 == r ? column(c) : NaN) \
           with linespoints lw 1.5 ps 0.6 pt (i % 6 + 4) lc rgb color(i) title word(compared, i)
  }
}
unset multiplot
)";
  return text;
}

std::string ratio_script(const std::vector<SceneResult>& results) {
  const std::size_t width = std::max<std::size_t>(600, 200 + 70 * results.size());
  std::string text = fmt::format(kHead, width, 900, "table1.svg");
  text += R"(set multiplot layout 2,1 title 'Table 1: intersections relative to no culling' font ',16'
set style data histograms
set style histogram clustered gap 1.5
set style fill solid 0.9 noborder
set grid ytics lc rgb '#dddddd'
set yrange [0:100]
set ylabel 'intersections, % of no culling'
set xtics rotate by -35 font ',10'
set key outside right top samplen 2 font ',10'
colors = '#1f77b4 #2ca02c #98df8a #d62728 #ff7f0e #ff9896'
title_of(i) = i == 1 ? 'ideal' : i == 2 ? 'R_ray = R' : i == 3 ? 'R_ray = 2R' : i == 4 ? '256, per node' : i == 5 ? '256, summed' : '256, ours'
width = 1.0 / 7.5
do for [r = 4:6:2] {
  set title sprintf('R = %d (dots: published)', r)
  file = sprintf('< awk -F, ''NR > 1 && $2 == %d'' table1.csv', r)
  plot for [i = 1:6] file using (column(i + 2)):xtic(1) lc rgb word(colors, i) title title_of(i), \
       for [i = 1:4] file using ($0 + (i - 3.5) * width):(column(i + 8)) with points pt 7 ps 0.5 lc rgb 'black' \
         title (i == 1 ? 'published' : '')
}
unset multiplot
)";
  return text;
}

}  // namespace

void write_plot_files(const std::vector<SceneResult>& results, const std::filesystem::path& folder) {
  write_file(folder, "fig8.csv", level_data(results));
  write_file(folder, "fig8.gp", level_script(results));
  write_file(folder, "table1.csv", ratio_data(results));
  write_file(folder, "table1.gp", ratio_script(results));
}

void draw_plots(const std::filesystem::path& folder) {
  if (!have_gnuplot()) return;
  run_gnuplot(folder, "table1.gp");
  run_gnuplot(folder, "fig8.gp");
}

}  // namespace ctu::sim::paper
