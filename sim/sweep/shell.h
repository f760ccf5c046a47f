// Programs of others, run by the shell.
#pragma once

#include <string>
#include <vector>

namespace ctu::sweep {

/// A word as a shell takes it for itself: in quotes unless it has plain signs only.
std::string quoted(const std::string& word);
std::string quoted(const std::vector<std::string>& words);

struct ShellOutcome {
  int exit_code = 0;
  std::string out;  ///< of stdout and stderr
};
ShellOutcome run_shell(const std::vector<std::string>& words);

}  // namespace ctu::sweep
