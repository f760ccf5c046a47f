// Content identity (not security): XXH3-128 as 32 hexadecimal digits. Names scenes, traces and
// configurations in every result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ctu {

struct Hash128 {
  std::uint64_t low = 0, high = 0;
  bool operator==(const Hash128&) const = default;
  std::string hex() const;  ///< 32 digits, high word first
};

/// Feeds bytes piece by piece; `digest` may be asked at any time.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;
  void add(const void* data, std::size_t bytes);
  void add(std::string_view text) { add(text.data(), text.size()); }
  Hash128 digest() const;

 private:
  void* state_;
};

Hash128 hash_bytes(const void* data, std::size_t bytes);

/// The checksum of file sections: XXH3-64.
std::uint64_t hash64(const void* data, std::size_t bytes);

}  // namespace ctu
