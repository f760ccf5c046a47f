// Random masks for the tests of compression: sparse, dense, boxes and their unions, so that some hold others.
#pragma once

#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "model/cull/options.h"

namespace ctu::test {

class RandomMasks {
 public:
  RandomMasks(std::uint64_t seed, int resolution) : random_(seed), resolution_(resolution) {}

  std::vector<std::uint64_t> one() {
    const double densities[] = {0.02, 0.1, 0.4, 0.9, 1.0};
    const bool boxes = integer(0, 1) == 1;
    std::vector<std::uint64_t> mask(static_cast<std::size_t>(cull::words_per_mask(resolution_)));
    if (boxes)
      for (int i = integer(1, 3); i > 0; --i) add_box(mask);
    else
      add_cells(mask, densities[integer(0, 4)]);
    return mask;
  }

  /// `count` masks, one behind the other.
  std::vector<std::uint64_t> many(int count) {
    std::vector<std::uint64_t> masks;
    for (int i = 0; i < count; ++i) {
      const std::vector<std::uint64_t> mask = one();
      masks.insert(masks.end(), mask.begin(), mask.end());
    }
    return masks;
  }

  int integer(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

 private:
  void set(std::vector<std::uint64_t>& mask, int bit) {
    mask[static_cast<std::size_t>(bit / 64)] |= std::uint64_t{1} << (bit % 64);
  }
  void add_cells(std::vector<std::uint64_t>& mask, double density) {
    for (int bit = 0; bit < resolution_ * resolution_ * resolution_; ++bit)
      if (std::uniform_real_distribution<double>(0, 1)(random_) < density) set(mask, bit);
  }
  void add_box(std::vector<std::uint64_t>& mask) {
    int first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = integer(0, resolution_ - 1);
      last[axis] = integer(first[axis], resolution_ - 1);
    }
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) set(mask, cull::cell_bit(resolution_, x, y, z));
  }

  std::mt19937_64 random_;
  int resolution_;
};

/// The exact bits, for failure messages.
inline std::string text(const std::vector<std::uint64_t>& mask) {
  std::string out;
  char word[20];
  for (const std::uint64_t bits : mask) {
    std::snprintf(word, sizeof word, "%016llx ", static_cast<unsigned long long>(bits));
    out += word;
  }
  return out;
}

}  // namespace ctu::test
