// The model's tokens as the flat vectors of rtl/tokens.svh, without the data of memory's lines, which the model leaves
// out.
#pragma once

#include <array>

#include "model/pipeline/tokens.h"
#include "sim/cosim/bit_fields.h"

namespace ctu::cosim {

inline constexpr int kTokenWords = 5;
using TokenBits = std::array<std::uint32_t, kTokenWords>;

/// What the vectors' widths depend on.
struct TokenWidths {
  int slot = 6;
  int address = 40;
};

inline TokenBits bits_of(const pipeline::SlotToken& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::LeafToken& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.ref, 32).put(token.met, 16).put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::JoinToken& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.closes, 1).put(token.joins, 1).put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::StartToken& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.last, 1).put(token.packet, 6).put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::PacketToken& token, const TokenWidths&) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.packet, 6);
  return bits;
}
inline TokenBits bits_of(const pipeline::RefToken& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.ref, 32).put(token.slot, widths.slot).put(token.of_packet, 1);
  return bits;
}
inline TokenBits bits_of(const pipeline::NodeToken& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data())
      .put(token.asked, 4)
      .put(token.order, 8)
      .put(token.survivors, 4)
      .put(token.hits, 4)
      .put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::ComputedTest& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data())
      .put(token.candidate.primitive, 32)
      .put(token.candidate.v)
      .put(token.candidate.u)
      .put(token.candidate.t)
      .put(token.hit, 1)
      .put(token.last, 1)
      .put(token.index, 4)
      .put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::LeafDone& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.finished, 1).put(token.slot, widths.slot);
  return bits;
}
inline TokenBits bits_of(const pipeline::MemoryRequest& token, const TokenWidths& widths) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.write, 1).put(token.id, 8).put(token.address, widths.address);
  return bits;
}
inline TokenBits bits_of(const pipeline::MemoryResponse& token, const TokenWidths&) {
  TokenBits bits{};
  BitWriter(bits.data()).put(token.id, 8);
  return bits;
}

}  // namespace ctu::cosim
