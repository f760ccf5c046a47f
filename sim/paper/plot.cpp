#include "sim/paper/plot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <initializer_list>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"

extern char** environ;

namespace ctu::sim::paper {
namespace {

/// Runs a program found by PATH in `folder`, its output thrown away when `quiet`; its exit code, or -1 when it cannot
/// be started.
int run(const std::filesystem::path& folder, std::initializer_list<const char*> words, bool quiet) {
  std::vector<char*> argv;
  for (const char* word : words) argv.push_back(const_cast<char*>(word));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  if (quiet) posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, argv.front(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failure != 0 || waitpid(child, &status, 0) < 0) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

void write_file(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
  const std::string path = (folder / name).string();
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(path, "cannot be written", "choose another --out");
}

bool have_gnuplot() {
  if (run(".", {"gnuplot", "--version"}, true) == 0) return true;
  fmt::print(stderr,
             "gnuplot is not there, so the plots are not drawn; their data and scripts are written.\n"
             "  remedy: install the package gnuplot-nox, then run gnuplot on the .gp files\n");
  return false;
}

void run_gnuplot(const std::filesystem::path& folder, const std::string& script) {
  if (run(folder, {"gnuplot", script.c_str()}, false) != 0)
    throw Error((folder / script).string(), "gnuplot failed on it", "see its message above");
}

}  // namespace ctu::sim::paper
