// How many bytes a unit must be able to hold of one leaf.
#pragma once

#include <cstdint>

#include "model/accel/image.h"

namespace ctu::accel {

/// Of all leaves in the image; looks at every node.
std::uint32_t largest_leaf_bytes(const Image& image);

}  // namespace ctu::accel
