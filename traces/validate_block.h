// Is a block read from a file a walk through this image? After this check a replay can follow it without looking where
// it steps.
#pragma once

#include <string>

#include "model/accel/bvh4.h"
#include "model/cull/options.h"
#include "model/reference/ray_block.h"

namespace ctu::traces {

/// Follows every ray's steps with a stack of its own: each visit must be the reference that the stack gives, lanes,
/// order and leaf sizes must be those of the tree, keys must lie in the grid of `masks`, and the stack must end empty
/// (or at an any-hit ray's first hit). Where rays travel in packets, as `packets` says, each packet's visits must be
/// those that its search asks for, and end with its entries. Throws Error, at `path`, naming the ray. Blocks without
/// steps pass.
void validate_block(const reference::RayBlock& block, const accel::Bvh4& bvh, const cull::MaskOptions& masks,
                    const std::string& path, const reference::PacketPlan& packets = {});

}  // namespace ctu::traces
