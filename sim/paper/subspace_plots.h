// Table 1 and Fig. 8 as pictures: data (.csv), scripts (.gp) and, where gnuplot is installed, .svg.
#pragma once

#include <filesystem>
#include <vector>

#include "sim/paper/subspace_tables.h"

namespace ctu::sim::paper {

/// Writes table1.csv, table1.gp, fig8.csv and fig8.gp into `folder`. Throws Error when it cannot.
void write_plot_files(const std::vector<SceneResult>& results, const std::filesystem::path& folder);

/// Draws table1.svg and fig8.svg from them, or says what to install.
void draw_plots(const std::filesystem::path& folder);

}  // namespace ctu::sim::paper
