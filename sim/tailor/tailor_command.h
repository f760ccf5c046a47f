// `ctusim tailor`: what it is given and the function that does it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ctu::tailor {

struct TailorArgs {
  std::vector<std::string> traces;
  std::string config_path;        ///< the unit to start from; empty: the default one
  std::vector<std::string> sets;  ///< over it
  std::string slowdown = "1%";
  std::string output;  ///< TOML file; empty: printed
  std::string json_path;
  std::uint64_t sample = 16384;    ///< rays of each trace that the search replays; 0: all
  std::uint64_t gate_rays = 1000;  ///< of each trace, beside the unit in gates; 0: none
  int restarts = 3;
  std::uint64_t seed = 1;
  int threads = 0;
  bool build_rtl = false;  ///< where no build fits, make one
  bool area = false;       ///< synthesise both units with yosys
  bool markdown = false;
};

int tailor_command(const TailorArgs& args);

/// `ctusim tailor` and its options; `exit_code` is set when it was run.
void add_tailor(CLI::App& app, TailorArgs& args, int& exit_code);

}  // namespace ctu::tailor
