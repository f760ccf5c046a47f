#include "sim/area/elaboration.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string_view>

#include "model/base/hash.h"

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

/// The text with the numbers that end yosys' own names, "$add$x.sv:12$345_Y", counted from 0 in the order of the text.
std::string renumbered(const std::string& text) {
  std::map<std::string_view, std::size_t> numbers;
  std::string result;
  const std::string_view view = text;
  for (std::size_t i = 0; i < view.size();) {
    const std::size_t end = view[i] == '$' ? view.find_first_not_of("0123456789", i + 1) : i + 1;
    if (view[i] != '$' || end == i + 1 || end == view.npos || std::string_view(" _[\n").find(view[end]) == view.npos) {
      result += view[i++];
      continue;
    }
    const auto number = numbers.try_emplace(view.substr(i, end - i), numbers.size()).first;
    result += '$' + std::to_string(number->second);
    i = end;
  }
  return result;
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

std::map<std::string, std::string> Elaboration::identities(const std::string& module) const {
  std::map<std::string, std::string> identities;
  for (const std::string& name : with_inner(module)) {
    const ElaboratedModule& one = modules_.at(name);
    Hasher hasher;
    hasher.add(renumbered(one.text));
    for (const std::string& inner : one.instances) hasher.add(identities.at(inner));
    identities[name] = hasher.digest().hex();
  }
  return identities;
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
