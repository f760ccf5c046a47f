// Object masks on their way from the builder through the image to the mask test, compressed or not.
#pragma once

#include <memory>

#include "model/accel/bvh4.h"
#include "model/accel/image.h"
#include "model/cull/compression_lut.h"
#include "model/cull/object_masks.h"
#include "model/cull/options.h"

namespace ctu::traces {

/// The masks of a tree, with the compression LUT that they are entries of.
struct MaskSet {
  cull::ObjectMasks masks;
  std::shared_ptr<const cull::CompressionLut> lut;  ///< null: the masks are not compressed
};

/// What tests ask: `masks` themselves when `options` have no entries, their tightest entries otherwise.
MaskSet mask_set(const accel::Bvh4& bvh, cull::ObjectMasks masks, const cull::MaskOptions& options, int threads);

/// The same from the tree alone.
MaskSet make_masks(const accel::Bvh4& bvh, const cull::MaskOptions& options, int threads);

/// Orders tree and masks so that nodes whose masks are all full come last, and returns how many they are: they can be
/// laid out bare. The masks stay what they are.
std::uint32_t put_full_last(accel::Bvh4& bvh, MaskSet& set);

/// The image whose nodes carry the masks, or their indices; none when `set` is null. `layout.mask_bits` is filled in.
accel::Image image_of(const accel::Bvh4& bvh, const MaskSet* set, accel::ImageLayout layout);

/// The masks that an image carries, as the software asks them; `lut` as the image was made with. Empty bits when it
/// carries none. Every index must be one of the LUT.
cull::ObjectMasks masks_of(const accel::Image& image, const cull::MaskOptions& options,
                           const cull::CompressionLut* lut = nullptr);

}  // namespace ctu::traces
