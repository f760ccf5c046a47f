#include "sim/area/elaboration.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string_view>

namespace ctu::area {
namespace {

/// RTLIL writes a backslash before names that are not yosys' own.
std::string name_of(std::string_view token) { return std::string(token.starts_with('\\') ? token.substr(1) : token); }

std::string_view word(std::string_view line, int index) {
  std::size_t begin = 0;
  for (;; --index) {
    begin = line.find_first_not_of(' ', begin);
    if (begin == std::string_view::npos) return {};
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    if (index == 0) return line.substr(begin, end - begin);
    begin = end;
  }
}

bool is_port(std::string_view line) {
  return line.starts_with("  wire ") &&
         (line.find(" input ") != line.npos || line.find(" output ") != line.npos || line.find(" inout ") != line.npos);
}

/// Values that do not fit a number are left out: sized texts of bits.
void add_parameter(ElaboratedModule& module, std::string_view line) {
  const std::string_view value = word(line, 2);
  std::int64_t number = 0;
  const auto [end, failure] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (failure == std::errc() && end == value.data() + value.size()) module.parameters[name_of(word(line, 1))] = number;
}

bool is_module(std::string_view type) { return !type.starts_with('$') || type.starts_with("$paramod"); }

}  // namespace

Elaboration::Elaboration(const std::string& rtlil) {
  std::istringstream lines(rtlil);
  std::string line, before;  // attributes of the module that follows
  ElaboratedModule* module = nullptr;
  while (std::getline(lines, line)) {
    if (module == nullptr && line.starts_with("module ")) {
      module = &modules_[name_of(word(line, 1))];
      module->text = before;
      before.clear();
    } else if (module == nullptr) {
      if (line.starts_with("attribute ")) before += line + '\n';
      if (line.starts_with("autoidx ")) counter_ = line + '\n';
      continue;
    }
    module->text += line + '\n';
    if (line.starts_with("  parameter ")) add_parameter(*module, line);
    if (is_port(line)) module->ports += line + '\n';
    if (line.starts_with("  cell ") && is_module(word(line, 1))) module->instances.push_back(name_of(word(line, 1)));
    if (line == "end") module = nullptr;
  }
}

void Elaboration::add_inner(const std::string& module, std::set<std::string>& seen,
                            std::vector<std::string>& list) const {
  if (!seen.insert(module).second) return;
  for (const std::string& inner : modules_.at(module).instances) add_inner(inner, seen, list);
  list.push_back(module);
}

std::vector<std::string> Elaboration::with_inner(const std::string& module) const {
  std::set<std::string> seen;
  std::vector<std::string> list;
  add_inner(module, seen, list);
  return list;
}

std::string Elaboration::excerpt(const std::set<std::string>& modules) const {
  std::set<std::string> boxes;
  std::string text = counter_;
  for (const std::string& name : modules) {
    const ElaboratedModule& module = modules_.at(name);
    text += module.text;
    for (const std::string& inner : module.instances)
      if (!modules.contains(inner)) boxes.insert(inner);
  }
  for (const std::string& name : boxes)
    text += "attribute \\blackbox 1\nmodule " + (name.starts_with('$') ? name : '\\' + name) + '\n' +
            modules_.at(name).ports + "end\n";
  return text;
}

std::string plain_name(const std::string& module) {
  if (!module.starts_with("$paramod")) return module;
  const std::size_t begin = module.find('\\') + 1;
  return module.substr(begin, module.find('\\', begin) - begin);
}

}  // namespace ctu::area
