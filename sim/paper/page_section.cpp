#include "sim/paper/page_section.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::sim::paper {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error(path, "cannot be read", "name a page that is there");
  return text.str();
}

/// Where the section begins, behind its mark, and ends.
std::pair<std::size_t, std::size_t> place_of(const std::string& whole, const std::string& page,
                                             const std::string& name) {
  const std::string begin = fmt::format("<!-- begin: {} -->", name), end = fmt::format("<!-- end: {} -->", name);
  const std::size_t mark = whole.find(begin + "\n");
  const std::size_t last = mark == std::string::npos ? mark : whole.find(end, mark);
  if (last == std::string::npos)
    throw Error(page, fmt::format("has no section {}", name),
                fmt::format("put {} and {} where it goes, each on a line", begin, end));
  return {mark + begin.size() + 1, last};
}

/// Written beside it and renamed, so that an interruption leaves the page as it was.
void write_text(const std::string& path, const std::string& text) {
  const std::string unfinished = path + ".part";
  std::ofstream out(unfinished, std::ios::binary);
  out << text << std::flush;
  std::error_code failed;
  if (out) std::filesystem::rename(unfinished, path, failed);
  if (!out || failed) throw Error(path, "cannot be written", "choose a page that can be written");
}

/// Standard output into a temporary file, as long as this lives.
class Redirection {
 public:
  Redirection() : file_(std::tmpfile()), stdout_(dup(STDOUT_FILENO)) {
    if (file_ == nullptr || stdout_ < 0)
      throw Error("standard output", "cannot be kept", "make room for a temporary file");
    std::fflush(stdout);
    dup2(fileno(file_), STDOUT_FILENO);
  }
  ~Redirection() {
    restore();
    if (stdout_ >= 0) close(stdout_);
    if (file_ != nullptr) std::fclose(file_);
  }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

  std::string text() {
    restore();
    std::rewind(file_);
    std::string text;
    char part[4096];
    for (std::size_t read = 0; (read = std::fread(part, 1, sizeof part, file_)) > 0;) text.append(part, read);
    return text;
  }

 private:
  void restore() {
    std::fflush(stdout);
    dup2(stdout_, STDOUT_FILENO);
  }
  std::FILE* file_;
  int stdout_;
};

}  // namespace

void require_section(const std::string& page, const std::string& name) { place_of(read_text(page), page, name); }

void put_section(const std::string& page, const std::string& name, const std::string& text) {
  const std::string whole = read_text(page);
  const auto [first, last] = place_of(whole, page, name);
  write_text(page, whole.substr(0, first) + "\n" + text + "\n" + whole.substr(last));
}

std::string printed_by(const std::function<void()>& write) {
  Redirection redirection;
  write();
  const std::string text = redirection.text();
  fmt::print("{}", text);
  std::fflush(stdout);
  return text;
}

}  // namespace ctu::sim::paper
