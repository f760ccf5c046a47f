// Runs the program as a user does and keeps what it said.
#pragma once

#include <filesystem>
#include <string>

namespace ctu::test {

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

/// Runs `ctusim ARGUMENTS` in `folder`; `before` is what the shell does first.
Outcome run_program(const std::filesystem::path& folder, const std::string& arguments, const std::string& before = "");

/// A new empty folder below the system's temporary one, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace ctu::test
