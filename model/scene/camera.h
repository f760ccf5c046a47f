// The camera of scenes that state none.
#pragma once

#include "model/scene/scene.h"

namespace ctu::scene {

/// A three-quarter view from above with the whole bounding box inside a square picture. `up` is z for formats of
/// z-up worlds (hair, pbrt, nff, luxcore, generated), y for the rest. Computed in binary64 and rounded once.
Camera default_camera(const Scene& scene);

}  // namespace ctu::scene
