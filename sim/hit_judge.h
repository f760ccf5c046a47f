// Two walks found different hits for a ray: is one of them a defect?
#pragma once

#include <cstdint>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"

namespace ctu::sim {

/// What became of a ray whose hit is not the one of another walk.
enum class Verdict : std::uint8_t {
  Lost,      ///< in exact arithmetic the ray meets the triangle that only one of them found: a defect
  NearMiss,  ///< it does not: only the rounded triangle test accepts it
  Tie,       ///< two triangles at the same t, bit for bit: where they meet, rounding decides which one comes first
};

/// By exact arithmetic, of the hit that comes first.
Verdict judge_hits(const scene::Mesh& mesh, const intersect::Ray& ray, const intersect::Hit& a,
                   const intersect::Hit& b);

}  // namespace ctu::sim
