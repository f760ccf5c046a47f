// Files for gnuplot and the pictures it makes of them.
#pragma once

#include <filesystem>
#include <string>

namespace ctu::sim::paper {

/// Writes `text` to folder/name. Throws Error when it cannot.
void write_file(const std::filesystem::path& folder, const std::string& name, const std::string& text);

/// Whether there is a gnuplot; says on stderr what to install when there is none.
bool have_gnuplot();

/// Runs gnuplot on folder/script, in that folder. Throws Error when gnuplot fails.
void run_gnuplot(const std::filesystem::path& folder, const std::string& script);

}  // namespace ctu::sim::paper
