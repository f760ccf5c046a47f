#include "sim/area/yosys.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::area {
namespace {

constexpr const char *kInput = "in", *kOutput = "out", *kScript = "script", *kLog = "log";
constexpr int kCannotExecute = 126;

std::string shell_word(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A folder of its own, gone with the object.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (std::filesystem::temp_directory_path() / "ctusim-area-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw Error(pattern, "cannot make a folder there", "set TMPDIR to a folder that can be written");
    path_ = pattern;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  void write(const char* name, const std::string& text) const { std::ofstream(path_ / name, std::ios::binary) << text; }

 private:
  std::filesystem::path path_;
};

int exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }

/// The line that says why yosys gave up.
std::string error_line(const std::string& log) {
  std::istringstream lines(log);
  std::string line, last = "it ended without a reason";
  while (std::getline(lines, line))
    if (const auto at = line.find("ERROR: "); at != line.npos) last = line.substr(at + 7);
  return last;
}

}  // namespace

Yosys::Yosys(std::string program) : program_(std::move(program)) {
  FILE* const pipe = popen((shell_word(program_) + " -V 2>/dev/null").c_str(), "r");
  char line[256];
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr) version_ += line;
  if (pipe == nullptr || exit_code(pclose(pipe)) != 0 || !version_.starts_with("Yosys"))
    throw Error(program_, "yosys is not there or does not run", "install it (Debian: apt-get install yosys)");
}

std::string Yosys::run(const std::string& script, const std::string& in, const std::string& doing,
                       const Folders& folders) const {
  const Scratch scratch;
  for (const auto& [folder, name] : folders) std::filesystem::create_directory_symlink(folder, scratch / name);
  scratch.write(kInput, in);
  scratch.write(kScript, script);
  const std::string command = fmt::format("cd {} && {} -q -l {} -s {} >/dev/null 2>&1",
                                          shell_word((scratch / "").string()), shell_word(program_), kLog, kScript);
  const int code = exit_code(std::system(command.c_str()));
  if (code != 0)
    throw Error("yosys",
                fmt::format("{}: {}", doing,
                            code >= kCannotExecute ? "it cannot be run" : error_line(read_file(scratch / kLog))),
                "`./dev test` says whether the RTL is in order for this yosys");
  return read_file(scratch / kOutput);
}

std::string Yosys::elaborate(const std::vector<std::filesystem::path>& sources, const std::string& top,
                             const RtlParameters& parameters) const {
  // Folders by short names, as yosys takes no spaces in an -I; the same names whichever files they hold.
  const auto folder_of = [](const auto& source) { return std::filesystem::absolute(source).parent_path(); };
  Folders folders;
  std::string files;
  for (const auto& source : sources) folders[folder_of(source)];
  for (int number = 0; auto& [folder, name] : folders) name = fmt::format("rtl{}", number++);
  for (const auto& source : sources)
    if (source.extension() == ".sv")
      files += fmt::format(" \"{}/{}\"", folders.at(folder_of(source)), source.filename().string());
  std::string script = "read_verilog -sv -defer";
  for (const auto& [folder, name] : folders) script += " -I" + name;
  script += files + "\nhierarchy -check -top " + top;
  for (const auto& [name, value] : parameters) script += fmt::format(" -chparam {} {}", name, value);
  return run(script + fmt::format("\nwrite_rtlil {}\n", kOutput), "", "reading the RTL", folders);
}

std::string Yosys::synthesis_script(Target target) {
  if (target == Target::Ecp5)
    return fmt::format(
        "read_rtlil {}\nread_verilog -lib -specify +/ecp5/cells_sim.v +/ecp5/cells_bb.v\n"
        "synth_ecp5 -noflatten -nowidelut -run coarse:check\njson -o {}\n",
        kInput, kOutput);
  // `synth` without memory_map, which would make flip-flops of memories.
  return fmt::format("read_rtlil {}\n", kInput) +
         "proc\nopt_expr\nopt_clean\nopt -nodffe -nosdff\nwreduce\npeepopt\nopt_clean\nalumacc\nopt\nmemory -nomap\n"
         "opt_clean\nopt -fast -full\nopt -undriven -fine\ntechmap\nopt -fast\nabc -fast\nopt -fast\n" +
         fmt::format("setattr -unset src\njson -o {}\n", kOutput);
}

std::string Yosys::synthesise(const std::string& rtlil, Target target) const {
  return run(synthesis_script(target), rtlil, "synthesis");
}

}  // namespace ctu::area
