#include "sim/sweep/shell.h"

#include <sys/wait.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace ctu::sweep {

std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.,:=/+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word);
  return text;
}

ShellOutcome run_shell(const std::vector<std::string>& words) {
  std::fflush(nullptr);
  FILE* pipe = ::popen((quoted(words) + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::system_error(errno, std::generic_category(), words.front());
  ShellOutcome outcome;
  char buffer[4096];
  for (std::size_t got;
       (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0 || (std::ferror(pipe) && errno == EINTR);)
    if (got > 0)
      outcome.out.append(buffer, got);
    else
      std::clearerr(pipe);
  const int status = ::pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

}  // namespace ctu::sweep
