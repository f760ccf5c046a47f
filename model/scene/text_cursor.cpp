#include "model/scene/text_cursor.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "model/base/error.h"

namespace ctu::scene {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// from_chars reports underflow and overflow alike. With the exponent's sign the two are told apart: a number that is
// out of range and below one is too small.
bool is_too_small(std::string_view word) {
  const auto exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos && exponent + 1 < word.size() && word[exponent + 1] == '-') return true;
  if (exponent != std::string_view::npos) return false;
  const auto first = word.find_first_of("123456789");
  return word.find('.') < first;
}

template <class Number>
bool parse(std::string_view word, Number& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  if (!word.empty() && word.front() == '+') return false;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return false;
  if (error == std::errc::result_out_of_range && is_too_small(word)) {
    value = word.front() == '-' ? Number{-0.0} : Number{0};
    return true;
  }
  return error == std::errc{} && std::isfinite(value);
}

}  // namespace

bool parse_number(std::string_view word, float& value) { return parse(word, value); }
bool parse_number(std::string_view word, double& value) { return parse(word, value); }

bool TextCursor::at_end() {
  const std::string& text = file_.bytes;
  while (offset_ < text.size()) {
    if (comment_ != 0 && text[offset_] == comment_)
      offset_ = std::min(text.find('\n', offset_), text.size());
    else if (is_space(text[offset_]))
      ++offset_;
    else
      return false;
  }
  return true;
}

std::string_view TextCursor::word(std::string_view what) {
  if (at_end()) {
    word_offset_ = file_.bytes.size();
    fail(fmt::format("the file ends where {} should follow", what), "the file is cut off: fetch or export it again");
  }
  word_offset_ = offset_;
  const std::string& text = file_.bytes;
  while (offset_ < text.size() && !is_space(text[offset_])) ++offset_;
  return std::string_view(text).substr(word_offset_, offset_ - word_offset_);
}

template <class Number>
Number TextCursor::real(std::string_view what) {
  const std::string_view text = word(what);
  Number value;
  if (!parse_number(text, value))
    fail(fmt::format("'{}' is not a finite {} number, where {} should be", text.substr(0, 40),
                     std::is_same_v<Number, float> ? "binary32" : "binary64", what),
         "correct the line");
  return value;
}

float TextCursor::number(std::string_view what) { return real<float>(what); }
double TextCursor::wide_number(std::string_view what) { return real<double>(what); }

std::int64_t TextCursor::integer(std::string_view what) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    fail(fmt::format("'{}' is not an integer, where {} should be", text.substr(0, 40), what), "correct the line");
  return value;
}

std::string_view TextCursor::rest_of_line() {
  const std::string& text = file_.bytes;
  const std::size_t first = offset_;
  offset_ = std::min(text.find('\n', first), text.size());
  std::size_t last = offset_;
  if (last > first && text[last - 1] == '\r') --last;
  return std::string_view(text).substr(first, last - first);
}

void TextCursor::fail(const std::string& problem, const std::string& remedy) const {
  throw Error(where().text(), problem, remedy);
}

}  // namespace ctu::scene
