#include "sim/config_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "model/base/nearest.h"
#include "model/base/read_file.h"
#include "sim/config_parts.h"

namespace ctu::sim {
namespace {

using pipeline::Parameter;
using pipeline::ParameterValue;
using pipeline::UnitConfig;

const Parameter& find_parameter(const std::string& key, const std::string& where) {
  const auto& all = pipeline::parameters();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.key == key; });
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const Parameter& p : all) names.push_back(p.key);
  throw Error(where, fmt::format("unknown key \"{}\"", key),
              fmt::format("did you mean \"{}\"? `ctusim config show` lists every key", nearest_name(key, names)));
}

std::string allowed_text(const Parameter& p) {
  if (std::holds_alternative<bool>(p.default_value)) return "true or false";
  if (std::holds_alternative<std::string>(p.default_value)) return fmt::format("one of {}", fmt::join(p.choices, ", "));
  return fmt::format("{} from {} to {}{}", p.power_of_two ? "a power of two" : "a whole number", p.minimum, p.maximum,
                     p.unit.empty() ? "" : " " + p.unit);
}

[[noreturn]] void refuse(const Parameter& p, const std::string& given, const std::string& where) {
  throw Error(where, fmt::format("{} = {} is not allowed", p.key, given), fmt::format("give {}", allowed_text(p)));
}

void assign(UnitConfig& config, const Parameter& p, const ParameterValue& value, const std::string& where) {
  if (value.index() != p.default_value.index()) refuse(p, to_text(value), where);
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    const bool in_range = *number >= p.minimum && *number <= p.maximum;
    const bool shape = !p.power_of_two || (*number > 0 && std::has_single_bit(static_cast<std::uint64_t>(*number)));
    if (!in_range || !shape) refuse(p, to_text(value), where);
  }
  if (const auto* text = std::get_if<std::string>(&value))
    if (std::find(p.choices.begin(), p.choices.end(), *text) == p.choices.end()) {
      throw Error(where, fmt::format("{} = \"{}\" is not allowed", p.key, *text),
                  fmt::format("did you mean \"{}\"? Give {}", nearest_name(*text, p.choices), allowed_text(p)));
    }
  p.set(config, value);
}

std::optional<ParameterValue> value_of(const toml::node& node) {
  if (const auto* b = node.as_boolean()) return ParameterValue(b->get());
  if (const auto* i = node.as_integer()) return ParameterValue(i->get());
  if (const auto* s = node.as_string()) return ParameterValue(s->get());
  return std::nullopt;
}

/// The section [parts], which is no configuration; null: it is not wanted here.
void take_parts(const toml::table& section, const std::string& path, PartValues* parts) {
  const std::string where = fmt::format("{}:{}", path, section.source().begin.line);
  if (parts == nullptr)
    throw Error(where,
                "[parts]: this is a unit tailored to some scenes, which only `ctusim run` checks a trace against",
                "run it with `ctusim run`, or take the section out for a unit with every part");
  for (const auto& [name, node] : section) {
    const auto value = value_of(node);
    if (!value) throw Error(where, fmt::format("parts.{} is no value", std::string(name.str())), "");
    (*parts)[std::string(name.str())] = *value;
  }
}

void apply_table(UnitConfig& config, const toml::table& table, const std::string& prefix, const std::string& path,
                 PartValues* parts) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    if (key == "parts" && node.is_table()) {
      take_parts(*node.as_table(), path, parts);
      continue;
    }
    if (const auto* inner = node.as_table()) {
      apply_table(config, *inner, key + ".", path, parts);
      continue;
    }
    const std::string where = fmt::format("{}:{}", path, node.source().begin.line);
    const Parameter& p = find_parameter(key, where);
    const auto value = value_of(node);
    if (!value) refuse(p, "(a list, date or fraction)", where);
    assign(config, p, *value, where);
  }
}

/// Keys of many parts become as many nested tables, which the parser takes apart by recursion. Dots are counted
/// wherever they stand: what is a comment or a string, only the parser knows.
void check_depth(const std::string& text, const std::string& path) {
  constexpr std::ptrdiff_t kMostDots = 32;
  std::int64_t number = 1;
  for (auto first = text.begin(); first != text.end(); ++number) {
    const auto end = std::find(first, text.end(), '\n');
    if (std::count(first, end, '.') > kMostDots)
      throw Error(fmt::format("{}:{}", path, number), fmt::format("more than {} dots in one line", kMostDots),
                  "no key has so many parts, and no comment needs them; `ctusim config show` lists every key");
    first = end == text.end() ? end : end + 1;
  }
}

void apply_file(UnitConfig& config, const std::string& path, PartValues* parts) {
  constexpr std::uint64_t kMostBytes = 1u << 20;
  const std::string text = read_file(path, kMostBytes, "`ctusim config show` prints a complete example");
  check_depth(text, path);
  try {
    apply_table(config, toml::parse(text, path), "", path, parts);
  } catch (const toml::parse_error& e) {
    const auto line = e.source().begin.line;
    throw Error(line > 0 ? fmt::format("{}:{}", path, line) : path, std::string(e.description()),
                "mend the TOML; `ctusim config show` prints a complete example");
  }
}

/// Text of --set to the type of the key.
ParameterValue parse_value(const Parameter& p, std::string_view text, const std::string& where) {
  if (std::holds_alternative<std::string>(p.default_value)) return std::string(text);
  if (std::holds_alternative<bool>(p.default_value)) {
    if (text == "true") return true;
    if (text == "false") return false;
    refuse(p, std::string(text), where);
  }
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) refuse(p, std::string(text), where);
  return number;
}

void apply_set(UnitConfig& config, const std::string& assignment) {
  const std::string where = "--set " + assignment;
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) throw Error(where, "no \"=\" in it", "write --set key=value");
  const Parameter& p = find_parameter(assignment.substr(0, equals), where);
  assign(config, p, parse_value(p, std::string_view(assignment).substr(equals + 1), where), where);
}

UnitConfig load(const std::string& path, const std::vector<std::string>& sets, PartValues* parts) {
  UnitConfig config;
  if (!path.empty()) apply_file(config, path, parts);
  for (const std::string& assignment : sets) apply_set(config, assignment);
  pipeline::check_consistency(config);
  return config;
}

std::string quoted(const ParameterValue& value) {
  return std::holds_alternative<std::string>(value) ? fmt::format("\"{}\"", std::get<std::string>(value))
                                                    : to_text(value);
}

}  // namespace

std::string to_text(const ParameterValue& value) {
  if (const auto* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<std::int64_t>(&value)) return std::to_string(*i);
  return std::get<std::string>(value);
}

UnitConfig load_config(const std::string& path, const std::vector<std::string>& sets) {
  return load(path, sets, nullptr);
}

UnitConfig load_config_with_parts(const std::string& path, const std::vector<std::string>& sets, PartValues& parts) {
  return load(path, sets, &parts);
}

std::string config_to_toml(const UnitConfig& config, bool documented) {
  std::string text, open_table;
  for (const Parameter& p : pipeline::parameters()) {
    const auto dot = p.key.rfind('.');
    const std::string table = dot == std::string::npos ? "" : p.key.substr(0, dot);
    if (table != open_table) {
      text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", table);
      open_table = table;
    }
    if (documented)
      text += fmt::format("# {}\n#   {}; default {}\n", p.description, allowed_text(p), quoted(p.default_value));
    text += fmt::format("{} = {}\n", dot == std::string::npos ? p.key : p.key.substr(dot + 1), quoted(p.get(config)));
  }
  return text;
}

std::string config_hash(const UnitConfig& config) {
  Hasher hasher;
  for (const Parameter& p : pipeline::parameters())
    if (!p.new_since_hashes || p.get(config) != p.default_value)
      hasher.add(p.key + "=" + to_text(p.get(config)) + "\n");
  return hasher.digest().hex();
}

}  // namespace ctu::sim
