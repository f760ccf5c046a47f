// Runs yosys, which reads and synthesises the RTL.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/area/module_area.h"

namespace ctu::area {

/// Parameters of the top module.
using RtlParameters = std::vector<std::pair<std::string, std::int64_t>>;

class Yosys {
 public:
  /// `program`: a path, or a name to look for. Throws Error when it is not there.
  explicit Yosys(std::string program);
  const std::string& version() const { return version_; }

  /// The sources of the folder, with these parameters, as RTLIL.
  std::string elaborate(const std::vector<std::filesystem::path>& sources, const std::string& top,
                        const RtlParameters& parameters) const;
  /// All modules of `rtlil` that are not black boxes, each by itself, as a JSON netlist.
  std::string synthesise(const std::string& rtlil, Target target) const;
  /// The commands that do it.
  static std::string synthesis_script(Target target);

 private:
  using Folders = std::map<std::filesystem::path, std::string>;

  /// What a script writes to the file "out", from the file "in" and folders under other names.
  std::string run(const std::string& script, const std::string& in, const std::string& doing,
                  const Folders& folders = {}) const;

  std::string program_, version_;
};

}  // namespace ctu::area
