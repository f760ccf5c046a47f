// The command line: subcommands and options. The only place that knows the command-line library.
#pragma once

namespace ctu::sim {

/// Parses and runs one command; the exit code. Bad usage is printed and gives 2; Errors of commands pass through.
int run_cli(int argc, const char* const* argv);

}  // namespace ctu::sim
