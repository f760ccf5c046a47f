#include "sim/sweep/toml_reader.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/nearest.h"

namespace ctu::sweep {

std::string TomlReader::where(const toml::node& node) const {
  const auto line = node.source().begin.line;
  return line > 0 ? fmt::format("{}:{}", path_, line) : path_;
}

void TomlReader::refuse(const toml::node& node, const std::string& what, const std::string& remedy) const {
  throw Error(where(node), what, remedy);
}

void TomlReader::expect_keys(const toml::table& table, std::initializer_list<const char*> known) const {
  for (const auto& [key, node] : table)
    if (std::none_of(known.begin(), known.end(), [&](const char* name) { return key.str() == name; }))
      refuse(node, fmt::format("unknown key \"{}\"", key.str()),
             fmt::format("did you mean \"{}\"?",
                         nearest_name(key.str(), std::vector<std::string>(known.begin(), known.end()))));
}

std::string TomlReader::scalar(const toml::node& node) const {
  if (const auto* b = node.as_boolean()) return b->get() ? "true" : "false";
  if (const auto* i = node.as_integer()) return std::to_string(i->get());
  if (const auto* s = node.as_string()) return s->get();
  refuse(node, "is no value of a parameter", "give a string, a whole number, true or false");
}

std::string TomlReader::text(const toml::table& table, const char* key, const std::string& otherwise) const {
  const toml::node* node = table.get(key);
  if (node == nullptr) return otherwise;
  if (const auto* s = node->as_string()) return s->get();
  refuse(*node, fmt::format("{} is no string", key), fmt::format("write {} = \"...\"", key));
}

std::uint64_t TomlReader::number(const toml::table& table, const char* key, std::uint64_t otherwise) const {
  const toml::node* node = table.get(key);
  if (node == nullptr) return otherwise;
  const auto* i = node->as_integer();
  if (i == nullptr || i->get() < 0)
    refuse(*node, fmt::format("{} is no whole number from 0 on", key), fmt::format("write {} = 1", key));
  return static_cast<std::uint64_t>(i->get());
}

std::int64_t TomlReader::integer(const toml::node& node) const {
  if (const auto* i = node.as_integer()) return i->get();
  refuse(node, "is no whole number", "give one");
}

std::vector<std::int64_t> TomlReader::integers(const toml::node& node, std::size_t least, std::size_t most) const {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() < least || list->size() > most)
    refuse(node, "is no list of as many whole numbers", "write range = [first, last, step] or log2 = [first, last]");
  std::vector<std::int64_t> numbers;
  for (const toml::node& element : *list) numbers.push_back(integer(element));
  return numbers;
}

std::vector<std::string> TomlReader::values(const toml::node& node) const {
  std::vector<std::string> found;
  if (const toml::array* list = node.as_array()) {
    if (list->empty()) refuse(node, "an empty list leaves no point", "give one value at least");
    for (const toml::node& element : *list) found.push_back(scalar(element));
    return found;
  }
  const toml::table* table = node.as_table();
  if (table == nullptr) return {scalar(node)};
  expect_keys(*table, {"range", "log2"});
  if (table->size() != 1) refuse(node, "is neither range nor log2", "give one of them");
  std::vector<std::int64_t> numbers;
  if (const toml::node* range = table->get("range")) {
    const auto ends = integers(*range, 2, 3);
    numbers = stepped_values(ends[0], ends[1], ends.size() == 3 ? ends[2] : 1, where(*range));
  } else if (const toml::node* log2 = table->get("log2")) {
    const auto ends = integers(*log2, 2, 2);
    numbers = doubled_values(ends[0], ends[1], where(*log2));
  }
  for (const std::int64_t value : numbers) found.push_back(std::to_string(value));
  return found;
}

void TomlReader::flatten(const toml::table& table, std::initializer_list<const char*> kept, const Visit& visit) const {
  flatten(table, std::vector<std::string>(kept.begin(), kept.end()), "", visit);
}

void TomlReader::flatten(const toml::table& table, const std::vector<std::string>& kept, const std::string& prefix,
                         const Visit& visit) const {
  // In the order of the file, not of the alphabet: the order of axes is the order of points.
  std::vector<std::pair<std::string, const toml::node*>> ordered;
  for (const auto& [key, node] : table) ordered.emplace_back(std::string(key.str()), &node);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) {
    const auto &left = a.second->source().begin, &right = b.second->source().begin;
    return left.line != right.line ? left.line < right.line : left.column < right.column;
  });
  for (const auto& [name, node] : ordered) {
    const toml::table* inner = node->as_table();
    const bool is_value = inner == nullptr || std::any_of(kept.begin(), kept.end(),
                                                          [&](const std::string& key) { return inner->contains(key); });
    if (is_value)
      visit(prefix + name, *node);
    else
      flatten(*inner, kept, prefix + name + ".", visit);
  }
}

toml::table parse_toml(const std::string& text, const std::string& path) {
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& e) {
    const auto line = e.source().begin.line;
    throw Error(line > 0 ? fmt::format("{}:{}", path, line) : path, std::string(e.description()),
                "mend the TOML; docs/sweeps.md shows a complete example");
  }
}

}  // namespace ctu::sweep
