// A parameter of the unit as the outside sees it: key, unit, range, meaning. The TOML reader, `--set`, `config show`
// and the documentation all come from the one list of these.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace ctu::pipeline {

struct UnitConfig;

using ParameterValue = std::variant<bool, std::int64_t, std::string>;

struct Parameter {
  std::string key;          ///< as in TOML and --set: "node_cache.ways"
  std::string unit;         ///< "cycles", "bytes", "entries", ... or "" for a choice
  std::string description;  ///< meaning, and where the default comes from
  ParameterValue default_value;
  std::int64_t minimum = 0, maximum = 0;  ///< of integers
  bool power_of_two = false;
  std::vector<std::string> choices;  ///< of strings
  std::function<ParameterValue(const UnitConfig&)> get;
  std::function<void(UnitConfig&, const ParameterValue&)> set;
  /// It came when hashes of configurations were in use already: at its default it is no part of them.
  bool new_since_hashes = false;
};

/// Every parameter, in the order of the documentation.
const std::vector<Parameter>& parameters();

/// Rules between parameters (a line not larger than the cache, ...): throws Error naming the keys.
void check_consistency(const UnitConfig& config);

}  // namespace ctu::pipeline
