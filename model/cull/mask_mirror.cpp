#include "model/cull/mask_mirror.h"

#include <bit>

namespace ctu::cull {

std::vector<std::uint64_t> mirrored_mask(const std::uint64_t* mask, int resolution, unsigned axes) {
  const int words = words_per_mask(resolution), last = resolution - 1;
  const auto place = [&](int cell, unsigned axis) { return (axes >> axis & 1) != 0 ? last - cell : cell; };
  std::vector<std::uint64_t> mirrored(static_cast<std::size_t>(words));
  for (int w = 0; w < words; ++w)
    for (std::uint64_t rest = mask[w]; rest != 0; rest &= rest - 1) {
      const int cell = 64 * w + std::countr_zero(rest);
      const int x = cell % resolution, y = cell / resolution % resolution, z = cell / (resolution * resolution);
      const int bit = cell_bit(resolution, place(x, 0), place(y, 1), place(z, 2));
      mirrored[static_cast<std::size_t>(bit / 64)] |= std::uint64_t{1} << (bit % 64);
    }
  return mirrored;
}

MirrorNumbering::Number MirrorNumbering::number_of(const std::uint64_t* mask) {
  std::vector<std::uint64_t> least(mask, mask + words_per_mask(resolution_));
  unsigned axes = 0;
  for (unsigned mirrors = 1; mirrors < 8; ++mirrors) {
    std::vector<std::uint64_t> image = mirrored_mask(mask, resolution_, mirrors);
    if (image >= least) continue;
    least = std::move(image);
    axes = mirrors;
  }
  return {numbering_.number_of(least.data()), axes};
}

}  // namespace ctu::cull
