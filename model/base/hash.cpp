#include "model/base/hash.h"

#include <xxhash.h>

#include <new>

namespace ctu {
namespace {
XXH3_state_t* state_of(void* p) { return static_cast<XXH3_state_t*>(p); }
}  // namespace

std::string Hash128::hex() const {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text(32, '0');
  for (int i = 0; i < 16; ++i) {
    text[15 - i] = kDigits[(high >> (4 * i)) & 15];
    text[31 - i] = kDigits[(low >> (4 * i)) & 15];
  }
  return text;
}

Hasher::Hasher() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_of(state_));
}
Hasher::~Hasher() { XXH3_freeState(state_of(state_)); }
void Hasher::add(const void* data, std::size_t bytes) {
  if (bytes != 0) XXH3_128bits_update(state_of(state_), data, bytes);
}
Hash128 Hasher::digest() const {
  const XXH128_hash_t h = XXH3_128bits_digest(state_of(state_));
  return {h.low64, h.high64};
}

Hash128 hash_bytes(const void* data, std::size_t bytes) {
  const XXH128_hash_t h = XXH3_128bits(data, bytes);
  return {h.low64, h.high64};
}

std::uint64_t hash64(const void* data, std::size_t bytes) { return XXH3_64bits(data, bytes); }

}  // namespace ctu
