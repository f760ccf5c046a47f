// Fields of flat vectors, lowest bits first, in the arrays of 32-bit words that Verilator keeps wide signals in.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace ctu::cosim {

class BitWriter {
 public:
  explicit BitWriter(std::uint32_t* words) : words_(words) {}
  BitWriter& put(std::uint64_t value, int bits) {
    while (bits > 0) {
      const int place = static_cast<int>(at_ & 31);
      const int count = bits < 32 - place ? bits : 32 - place;
      const std::uint32_t mask = (count == 32 ? ~0u : (1u << count) - 1) << place;
      words_[at_ / 32] = (words_[at_ / 32] & ~mask) | (static_cast<std::uint32_t>(value << place) & mask);
      value >>= count;
      at_ += static_cast<std::size_t>(count);
      bits -= count;
    }
    return *this;
  }
  std::size_t size() const { return at_; }  ///< bits written
  BitWriter& put(float value) { return put(std::bit_cast<std::uint32_t>(value), 32); }

 private:
  std::uint32_t* words_;
  std::size_t at_ = 0;
};

}  // namespace ctu::cosim
