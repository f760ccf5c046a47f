// Numbers masks in the order of their first appearance, equal ones alike.
#pragma once

#include <cstdint>
#include <vector>

namespace ctu::cull {

class MaskNumbering {
 public:
  explicit MaskNumbering(int words) : words_(words), slots_(1u << 10, kFree) {}

  /// The mask's number; a mask that was not there gets the next.
  std::uint32_t number_of(const std::uint64_t* mask);

  std::uint32_t count() const { return count_; }
  /// All masks by their numbers, one behind the other.
  const std::vector<std::uint64_t>& masks() const { return masks_; }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};
  std::size_t slot_of(const std::uint64_t* mask) const;
  void grow();

  int words_;
  std::uint32_t count_ = 0;
  std::vector<std::uint64_t> masks_;
  std::vector<std::uint32_t> slots_;  ///< open addressing, at most half full; the size is a power of two
};

}  // namespace ctu::cull
