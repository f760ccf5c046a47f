// A TOML table read with the place of every value at hand, so that each mistake is told by file and line.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "sim/sweep/axis.h"

namespace ctu::sweep {

class TomlReader {
 public:
  explicit TomlReader(std::string path) : path_(std::move(path)) {}

  std::string where(const toml::node& node) const;
  [[noreturn]] void refuse(const toml::node& node, const std::string& what, const std::string& remedy) const;

  /// Throws Error on a key of the table that is not one of these.
  void expect_keys(const toml::table& table, std::initializer_list<const char*> known) const;

  /// The value as it stands behind --set; Error on anything but a string, whole number or boolean.
  std::string scalar(const toml::node& node) const;
  std::string text(const toml::table& table, const char* key, const std::string& otherwise) const;
  /// Not negative.
  std::uint64_t number(const toml::table& table, const char* key, std::uint64_t otherwise) const;
  std::int64_t integer(const toml::node& node) const;

  /// A value, a list of values, { range = [first, last, step] } or { log2 = [first, last] }.
  std::vector<std::string> values(const toml::node& node) const;

  using Visit = std::function<void(const std::string& key, const toml::node& node)>;
  /// Tables within tables by the dotted key of what they hold. A table that has one of `kept` among its keys is a
  /// value.
  void flatten(const toml::table& table, std::initializer_list<const char*> kept, const Visit& visit) const;

 private:
  void flatten(const toml::table& table, const std::vector<std::string>& kept, const std::string& prefix,
               const Visit& visit) const;
  std::vector<std::int64_t> integers(const toml::node& node, std::size_t least, std::size_t most) const;

  std::string path_;
};

/// The file's text as a table; Error with the line on what is no TOML.
toml::table parse_toml(const std::string& text, const std::string& path);

}  // namespace ctu::sweep
