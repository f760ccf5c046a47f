// The lines of a node or a leaf: those of one span of bytes.
#pragma once

#include <bit>
#include <type_traits>

#include "model/pipeline/cache.h"
#include "model/pipeline/tokens.h"
#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

/// `DoneToken` is what the fetch hands on: RefToken for nodes, LeafToken for leaves.
template <class DoneToken>
class SpanLines {
 public:
  using Token = RefToken;
  using Done = DoneToken;
  static constexpr int kRounds = 1;
  static constexpr bool kMayNeedNone = false;
  static constexpr bool kServesPackets = std::is_same_v<DoneToken, RefToken>;

  SpanLines(const UnitImage& image, int line_bytes)
      : image_(image), line_shift_(std::countr_zero(static_cast<unsigned>(line_bytes))) {}

  static Done done(const Token& token) { return {token.ref, token.slot}; }
  static bool of_packet(const Token& token) { return token.of_packet; }

  /// Goes to the first line of the token; the bytes it asks for.
  std::uint64_t start(const Token& token) {
    const ByteSpan span = image_.bytes(token.ref);
    line_ = span.first >> line_shift_;
    last_line_ = span.last >> line_shift_;
    return span.last - span.first + 1;
  }
  LineNumber current() const { return line_; }
  /// Goes to the next line, if there is one.
  bool next() { return line_++ != last_line_; }

 private:
  const UnitImage& image_;
  int line_shift_;
  LineNumber line_ = 0, last_line_ = 0;
};

}  // namespace ctu::pipeline
