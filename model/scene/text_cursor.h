// Walks the words and numbers of a text file. Lines are counted only when a message needs one, so walking stays fast.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "model/scene/place.h"
#include "model/scene/source_file.h"

namespace ctu::scene {

class TextCursor {
 public:
  /// `comment` starts a comment up to the end of its line; 0: there are none.
  explicit TextCursor(const SourceFile& file, char comment = 0, std::size_t offset = 0)
      : file_(file), offset_(offset), comment_(comment) {}

  /// Skips space and comments; true if nothing else is left.
  bool at_end();
  /// The next word without spaces. Throws Error at the end of the file; `what` says what was wanted.
  std::string_view word(std::string_view what);
  /// The next word as a number, correctly rounded to nearest even. NaN, infinite and too large ones are Errors.
  float number(std::string_view what);
  double wide_number(std::string_view what);
  /// The next word as an integer.
  std::int64_t integer(std::string_view what);
  /// The rest of the current line.
  std::string_view rest_of_line();
  /// The next character without taking it; 0 at the end of the file.
  char peek() const { return offset_ < file_.bytes.size() ? file_.bytes[offset_] : '\0'; }
  void skip(std::size_t characters) { offset_ += characters; }

  std::size_t offset() const { return offset_; }
  std::size_t bytes_left() const { return file_.bytes.size() - offset_; }
  /// The word taken last.
  Place where() const { return where(word_offset_); }
  Place where(std::size_t offset) const { return {file_, offset}; }
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;

 private:
  template <class Number>
  Number real(std::string_view what);

  const SourceFile& file_;
  std::size_t offset_;
  std::size_t word_offset_ = 0;
  char comment_;
};

/// A decimal number as a whole word; a leading '+' is allowed. Numbers too small for the type become zero of their
/// sign. Returns false for anything else, for NaN and infinities, and for numbers too large.
bool parse_number(std::string_view word, float& value);
bool parse_number(std::string_view word, double& value);

}  // namespace ctu::scene
