// The hard cases that `ctusim check` asks of every execution: small scenes and the rays sent into them, made by named
// generators. Every case is valid input: finite vertices, rays that intersect::is_valid accepts.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"
#include "sim/check/case_random.h"

namespace ctu::sim::check {

/// One small scene (1 to about 300 triangles; "duplicates" some thousands) and 64 to 1024 rays asked of it.
struct HardCase {
  scene::Mesh mesh;
  std::vector<intersect::Ray> rays;
};

struct Generator {
  std::string_view name;  ///< for --only and the report: lower case, words joined by "-"
  std::string_view what;  ///< one line
  /// Appends to a case that is empty.
  void (*make)(CaseRandom& random, HardCase& out);
};

/// All of them, in a fixed order: a generator's place is its number in CaseRandom's stream.
std::span<const Generator> generators();

/// Scene number `scene` of generator number `generator`, remade from three numbers.
HardCase make_case(std::uint64_t seed, std::uint32_t generator, std::uint64_t scene);

}  // namespace ctu::sim::check
