// The RTL with all parameters put in, module by module, as yosys writes it (RTLIL), and any few of these modules as a
// design of their own.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ctu::area {

struct ElaboratedModule {
  std::string text;                                ///< all of it
  std::string ports;                               ///< the lines that declare its ports
  std::map<std::string, std::int64_t> parameters;  ///< those that are numbers
  std::vector<std::string> instances;  ///< modules inside it, in the order of the text, each as often as it is there
};

/// By name. A module with parameters has a name that tells them: "$paramod$...\float_add".
class Elaboration {
 public:
  explicit Elaboration(const std::string& rtlil);
  const ElaboratedModule& at(const std::string& module) const { return modules_.at(module); }
  /// The module and all that are inside it, each once, those inside before those around them.
  std::vector<std::string> with_inner(const std::string& module) const;
  /// What a module and all that are inside it are, apart from where yosys was when it numbered its names: the same for
  /// the same hardware, whatever else the sources hold. By name.
  std::map<std::string, std::string> identities(const std::string& module) const;
  /// RTLIL of these modules; others that stand in them are black boxes.
  std::string excerpt(const std::set<std::string>& modules) const;

 private:
  void add_inner(const std::string& module, std::set<std::string>& seen, std::vector<std::string>& list) const;

  std::string counter_;  ///< the line that tells yosys which names are taken
  std::map<std::string, ElaboratedModule> modules_;
};

/// "float_add" of "$paramod$...\float_add" or "$paramod\float_add\LATENCY=...".
std::string plain_name(const std::string& module);

}  // namespace ctu::area
