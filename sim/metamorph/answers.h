// What a tree answers to many rays: hits and event sequences, and whether two answers are the same bit for bit.
#pragma once

#include <cstdint>
#include <vector>

#include "model/intersect/ray.h"
#include "model/reference/traversal.h"
#include "sim/metamorph/transformation.h"

namespace ctu::sim::metamorph {

/// Rays are asked in chunks, so that threads share the work; the answers do not depend on the number of threads.
inline constexpr std::size_t kRaysPerChunk = 512;

struct Answers {
  std::vector<intersect::Hit> hits;
  std::vector<reference::StepList> steps;  ///< a chunk each; none when they are not recorded
};

enum class Record : bool { Hits, HitsAndSteps };

Answers ask(const reference::Traversal& traversal, const std::vector<intersect::Ray>& rays, int threads, Record record);

/// What each ray finds when every triangle is tested and the best kept; any-hit rays, too, have their nearest hit.
std::vector<intersect::Hit> best_of_all_triangles(const accel::Bvh4& bvh, const std::vector<intersect::Ray>& rays,
                                                  int threads);

enum class Keys : bool { Compared, Ignored };

/// Rays (those of `asked` where it is true) whose event sequences differ. Keys name cells along the axes, so they are
/// ignored where axes change places.
std::uint64_t different_steps(const Answers& a, const Answers& b, Keys keys, const std::vector<bool>& asked);

/// Rays whose hits `b` are not those of `a` with t transformed.
std::uint64_t different_hits(const std::vector<intersect::Hit>& a, const std::vector<intersect::Hit>& b,
                             const Transformation& transformation, const std::vector<bool>& asked);

}  // namespace ctu::sim::metamorph
