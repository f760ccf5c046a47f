// Walks the numbers of a binary file; reading past its end is an Error that names the byte.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "model/base/error.h"
#include "model/scene/source_file.h"

namespace ctu::scene {

class ByteCursor {
 public:
  explicit ByteCursor(const SourceFile& file, bool big_endian = false, std::size_t offset = 0)
      : file_(file), offset_(offset), swap_(big_endian != (std::endian::native == std::endian::big)) {}

  template <class Number>
  Number take(const char* what) {
    if (bytes_left() < sizeof(Number)) fail_at_end(what);
    char raw[sizeof(Number)];
    std::memcpy(raw, file_.bytes.data() + offset_, sizeof(Number));
    if (swap_) std::reverse(raw, raw + sizeof(Number));
    offset_ += sizeof(Number);
    Number value;
    std::memcpy(&value, raw, sizeof(Number));
    return value;
  }

  void skip(std::uint64_t bytes, const char* what) {
    if (bytes > bytes_left()) fail_at_end(what);
    offset_ += bytes;
  }

  /// Throws Error unless `count` items of `item_bytes` each are left: the check before any allocation by a count.
  void expect(std::uint64_t count, std::uint64_t item_bytes, const char* what) const {
    if (item_bytes != 0 && count > bytes_left() / item_bytes)
      throw Error(where(), fmt::format("{} {} need more than the {} bytes that are left", count, what, bytes_left()),
                  "the file is cut off or its header is damaged: fetch or export it again");
  }

  std::size_t offset() const { return offset_; }
  std::size_t bytes_left() const { return file_.bytes.size() - offset_; }
  std::string where() const { return fmt::format("{}: byte {}", file_.path, offset_); }

 private:
  [[noreturn]] void fail_at_end(const char* what) const {
    throw Error(where(), fmt::format("the file ends inside {}", what), "the file is cut off: fetch or export it again");
  }

  const SourceFile& file_;
  std::size_t offset_;
  bool swap_;
};

}  // namespace ctu::scene
