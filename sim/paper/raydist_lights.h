// The lights under which the ray-distribution paper's trees are compared: of both kinds, each in four orientations.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/influence/area.h"
#include "model/scene/scene.h"

namespace ctu::sim::paper {

inline constexpr std::array<const char*, 4> kOrientations = {"along an axis", "15 degrees", "45 degrees", "oblique"};

struct TestLight {
  influence::AreaKind kind = influence::AreaKind::Plane;
  std::size_t orientation = 0;  ///< of kOrientations: from which side it shines, against the scene's upward axis
  Vec3 place;

  std::string name() const;
};

/// A plane light stands so far away (1000 diagonals) that its rays are parallel to a twentieth of a degree. A point
/// light stands an eighth of the diagonal outside of the scene's sphere; or, where the camera is in the scene as in a
/// room, nine tenths of the way to its bounds.
std::vector<TestLight> test_lights(const scene::Scene& scene);

}  // namespace ctu::sim::paper
