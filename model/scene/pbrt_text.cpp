#include "model/scene/pbrt_text.h"

#include <fmt/core.h>

#include <algorithm>

#include "model/base/error.h"

namespace ctu::scene {
namespace {

constexpr const char* kCorrect = "correct the line; a cut-off file must be fetched again";
constexpr std::string_view kEnd = " \t\r\n\v\f\"[]#";

}  // namespace

// A quoted string with its quotes, a bracket, or a run of other characters.
std::string_view PbrtText::token() {
  if (text_.at_end()) {
    statement_offset_ = bytes_.size();
    fail("the file ends inside a statement", kCorrect);
  }
  const std::size_t first = text_.offset();
  const char c = bytes_[first];
  std::size_t end = first + 1;
  if (c == '"') {
    end = bytes_.find_first_of("\"\n", first + 1);
    if (end == std::string::npos || bytes_[end] != '"') {
      statement_offset_ = first;
      fail("a string without its closing quote", kCorrect);
    }
    ++end;
  } else if (c != '[' && c != ']') {
    end = std::min(bytes_.find_first_of(kEnd, first), bytes_.size());
  }
  text_.skip(end - first);
  return std::string_view(bytes_).substr(first, end - first);
}

// Bare true and false are values; any other word that starts with a letter begins a statement.
bool PbrtText::at_argument() {
  if (text_.at_end()) return false;
  const char c = text_.peek();
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  if (!letter) return true;
  const std::string_view rest = std::string_view(bytes_).substr(text_.offset(), 5);
  return rest == "false" || rest.starts_with("true");
}

bool PbrtText::take(char c) {
  if (text_.at_end() || text_.peek() != c) return false;
  text_.skip(1);
  return true;
}

std::string_view PbrtText::statement() {
  text_.at_end();
  statement_offset_ = text_.offset();
  if (at_argument()) fail("a value where a statement should begin", kCorrect);
  return token();
}

std::string_view PbrtText::quoted(std::string_view what) {
  const std::string_view t = token();
  if (t.size() < 2 || t.front() != '"')
    fail(fmt::format("{} in quotes should follow, not '{}'", what, t.substr(0, 40)), kCorrect);
  return t.substr(1, t.size() - 2);
}

double PbrtText::number(std::string_view what) {
  const std::string_view t = token();
  double value;
  if (!parse_number(t, value))
    fail(fmt::format("'{}' is not a finite number, where {} should be", t.substr(0, 40), what), kCorrect);
  return value;
}

void PbrtText::numbers(double* values, int count, std::string_view what) {
  const bool bracket = take('[');
  for (int i = 0; i < count; ++i) values[i] = number(what);
  if (bracket && !take(']')) fail(fmt::format("{} should be {} numbers", what, count), kCorrect);
}

std::vector<PbrtParameter> PbrtText::parameters(std::initializer_list<std::string_view> wanted) {
  std::vector<PbrtParameter> all;
  while (at_argument()) {
    const std::size_t offset = text_.offset();
    const std::string_view declared = quoted("a parameter's type and name");
    const std::size_t first = std::min(declared.find_first_not_of(" \t"), declared.size());
    const std::size_t gap = std::min(declared.find_first_of(" \t", first), declared.size());
    const std::size_t name = std::min(declared.find_first_not_of(" \t", gap), declared.size());
    const std::size_t name_end = std::min(declared.find_first_of(" \t", name), declared.size());
    PbrtParameter p{
        declared.substr(first, gap - first), declared.substr(name, name_end - name), text_.where(offset), {}};
    const bool keep = std::find(wanted.begin(), wanted.end(), p.name) != wanted.end();
    const bool list = take('[');
    while (list ? !take(']') : true) {
      const std::string_view value = token();
      if (value == "[" || value == "]") fail("brackets do not match", kCorrect);
      if (keep) p.values.push_back(value.front() == '"' ? value.substr(1, value.size() - 2) : value);
      if (!list) break;
    }
    all.push_back(std::move(p));
  }
  return all;
}

void PbrtText::skip_arguments() {
  while (at_argument()) token();
}

void PbrtText::fail(const std::string& problem, const std::string& remedy) const {
  throw Error(where().text(), problem, remedy);
}

}  // namespace ctu::scene
