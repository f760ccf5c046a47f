// What a unit works on.
#pragma once

#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/pipeline/unit_config.h"
#include "model/reference/ray_block.h"

namespace ctu::pipeline {

struct Work {
  const accel::Image& image;
  const cull::MaskTester& tester;
  reference::RayFeed& rays;
};

/// Throws Error where configuration and work do not fit: another design than the tester's, masks of another size, a
/// stack that no context can hold.
void check_fits(const UnitConfig& config, const Work& work);

}  // namespace ctu::pipeline
