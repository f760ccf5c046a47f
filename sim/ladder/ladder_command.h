// `ctusim ladder`: the same rays on the same unit by every engine, each with its error and its run time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ctu::ladder {

struct LadderArgs {
  std::string trace;
  std::vector<std::string> configs;  ///< files; none: the default unit
  std::vector<std::string> sets;     ///< over each
  std::string errors = "5%,2%,1%", confidence = "95%";
  std::uint64_t seed = 1;
  std::uint64_t first_ray = 0, rays = 0;
  bool rtl = false;
  std::uint64_t repetitions = 0;  ///< of each sample, to see how often its interval holds; 0: not asked
  bool markdown = false;
  std::string json_path;
  std::string output;   ///< folder of the plot and its data; empty: none
  std::string command;  ///< as it was typed
};

/// Adds the subcommand; running it sets `exit_code`.
void add_ladder(CLI::App& app, LadderArgs& args, int& exit_code);

/// 0; 1 when a run finds a wrong hit. Mistakes of the user are Errors.
int ladder_command(const LadderArgs& args);

}  // namespace ctu::ladder
