// What it means that a ray got another answer with culling than without: judged by exact arithmetic on the mesh itself,
// without any tree.
#pragma once

#include <cstdint>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"

namespace ctu::sim {

/// What became of a ray whose hit with culling is not the one without.
enum class Verdict : std::uint8_t {
  Lost,      ///< in exact arithmetic the ray meets a primitive that the answer does not account for: a defect
  NearMiss,  ///< it does not: only the rounded test accepts what is missing
  /// Another primitive at the same t, bit for bit: where two meet, rounding decides which one comes first. Or at a
  /// later t, as rounded, which the exact ray comes to first.
  Tie,
};

/// "LOST A HIT", "near miss", "tie".
const char* to_string(Verdict verdict);

class HitJudge {
 public:
  /// The mesh must outlive this.
  explicit HitJudge(const scene::Mesh& mesh) : mesh_(mesh) {}

  /// `without` and `with` are answers to the same valid ray and differ. A primitive that its test accepts at a
  /// t before the later answer makes that answer Lost if the exact ray meets it no later than there. Any hit answers
  /// an any-hit ray.
  Verdict judge(const intersect::Ray& ray, const intersect::Hit& without, const intersect::Hit& with) const;

  /// In exact arithmetic the ray meets the primitive within [tmin, tmax]; kNoPrimitive is never met.
  bool meets(const intersect::Ray& ray, std::uint32_t primitive) const;

  /// In exact arithmetic the ray meets some primitive within [tmin, tmax].
  bool meets_any(const intersect::Ray& ray) const;

 private:
  const scene::Mesh& mesh_;
};

}  // namespace ctu::sim
