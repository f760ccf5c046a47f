#include "sim/energy/energy_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "model/base/nearest.h"
#include "model/base/read_file.h"

namespace ctu::energy {
namespace {

constexpr const char* kRemedy = "docs/energy.md has the default table; copy sim/energy/default_table.toml and edit it";

[[noreturn]] void refuse(const std::string& place, const std::string& what) { throw Error(place, what, kRemedy); }

std::string text_of(const toml::table& table, const char* key, const std::string& place) {
  const auto* value = table[key].as_string();
  if (value == nullptr || value->get().empty()) refuse(place, fmt::format("{} is no text", key));
  return value->get();
}

TableEntry read_entry(const toml::table& table, const std::string& place) {
  for (const auto& [key, node] : table)
    if (key != "value" && key != "unit" && key != "source")
      refuse(place, fmt::format("\"{}\" is none of value, unit, source", std::string(key.str())));
  const auto value = table["value"].value<double>();
  if (!value || !std::isfinite(*value) || *value <= 0) refuse(place, "value is no positive number");
  return {*value, text_of(table, "unit", place), text_of(table, "source", place)};
}

/// Sections of entries, at most two deep; the strings beside them are name and technology.
std::map<std::string, TableEntry> read_entries(const toml::table& root, const std::string& place) {
  std::map<std::string, TableEntry> entries;
  for (const auto& [section, node] : root) {
    const std::string name(section.str());
    if (name == "name" || name == "technology") continue;
    const toml::table* inner = node.as_table();
    if (inner == nullptr) refuse(place, fmt::format("\"{}\" is no section", name));
    for (const auto& [key, entry] : *inner) {
      const std::string full = name + "." + std::string(key.str());
      if (!entry.is_table()) refuse(place, fmt::format("{} has no value, unit and source", full));
      entries[full] = read_entry(*entry.as_table(), fmt::format("{}:{}: {}", place, entry.source().begin.line, full));
    }
  }
  return entries;
}

/// The same entries in the same units.
void check_like(const std::map<std::string, TableEntry>& entries, const std::map<std::string, TableEntry>& model,
                const std::string& place) {
  std::vector<std::string> known;
  for (const auto& [key, entry] : model) known.push_back(key);
  for (const auto& [key, entry] : entries) {
    const auto found = model.find(key);
    if (found == model.end())
      refuse(place, fmt::format("unknown entry {}; did you mean {}?", key, nearest_name(key, known)));
    if (entry.unit != found->second.unit)
      refuse(place, fmt::format("{} is in {}, not in {}", key, entry.unit, found->second.unit));
  }
  for (const std::string& key : known)
    if (!entries.contains(key)) refuse(place, fmt::format("{} is missing", key));
}

}  // namespace

EnergyTable EnergyTable::parse(const std::string& text, const std::string& place) {
  EnergyTable table;
  try {
    const toml::table root = toml::parse(text, place);
    table.name_ = text_of(root, "name", place);
    table.technology_ = text_of(root, "technology", place);
    table.entries_ = read_entries(root, place);
  } catch (const toml::parse_error& e) {
    refuse(fmt::format("{}:{}", place, e.source().begin.line), std::string(e.description()));
  }
  table.hash_ = hash_bytes(text.data(), text.size()).hex();
  return table;
}

EnergyTable EnergyTable::read(const std::string& path) {
  constexpr std::uint64_t kMostBytes = 1u << 20;
  EnergyTable table = parse(read_file(path, kMostBytes, kRemedy), path);
  check_like(table.entries(), standard().entries(), path);
  return table;
}

const EnergyTable& EnergyTable::standard() {
  static const EnergyTable table = parse(default_table_text(), "default_table.toml");
  return table;
}

double EnergyTable::access_pj(double capacity_bits) const {
  const double bytes = std::max(capacity_bits / 8, at("memory.least_bytes"));
  return at("memory.access") / at("memory.access_bits") *
         std::pow(bytes / at("memory.access_bytes"), at("memory.capacity_exponent"));
}

double EnergyTable::leakage_pj(double nanowatts, double cycles) const {
  constexpr double kPicojoulesOfNanowattMicrosecond = 1e-3;
  return nanowatts * cycles / at("clock.frequency") * kPicojoulesOfNanowattMicrosecond;
}

}  // namespace ctu::energy
