// Writes a protobuf message field by field (the wire format of protobuf.dev, "Encoding"): what a trace for Perfetto
// needs of it, which is three kinds of fields.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ctu::sim {

class ProtoMessage {
 public:
  ProtoMessage& number(int field, std::uint64_t value) {
    varint(static_cast<std::uint64_t>(field) << 3 | kVarint);
    varint(value);
    return *this;
  }
  ProtoMessage& text(int field, std::string_view value) {
    varint(static_cast<std::uint64_t>(field) << 3 | kLengthDelimited);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtoMessage& message(int field, const ProtoMessage& value) { return text(field, value.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::uint64_t kVarint = 0, kLengthDelimited = 2;

  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace ctu::sim
