// The text of a .pbrt (version 3): statements of bare words, strings in quotes, numbers, and lists in brackets.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene/place.h"
#include "model/scene/source_file.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {

/// One parameter as in "float fov" [ 50 ]. Only its name is taken apart unless its value is wanted.
struct PbrtParameter {
  std::string_view type, name;
  Place where;
  std::vector<std::string_view> values;  ///< strings without quotes and numbers as written; empty unless wanted
};

class PbrtText {
 public:
  explicit PbrtText(const SourceFile& file) : text_(file, '#'), bytes_(file.bytes) {}

  bool at_end() { return text_.at_end(); }
  /// The next bare word, which begins a statement.
  std::string_view statement();
  /// The next quoted string, without its quotes.
  std::string_view quoted(std::string_view what);
  double number(std::string_view what);
  /// `count` numbers, in brackets or not.
  void numbers(double* values, int count, std::string_view what);
  /// The parameters that follow, with the values of those whose names are `wanted`.
  std::vector<PbrtParameter> parameters(std::initializer_list<std::string_view> wanted);
  /// Passes over strings, numbers and lists up to the next statement.
  void skip_arguments();

  /// The last statement.
  Place where() const { return text_.where(statement_offset_); }
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;

 private:
  std::string_view token();
  bool at_argument();
  bool take(char c);

  TextCursor text_;
  const std::string& bytes_;
  std::size_t statement_offset_ = 0;
};

}  // namespace ctu::scene
