// What one test says of all rays of a packet, and what it is asked about.
//
// Every answer but Undecided holds for each ray by itself, in exact arithmetic and within its own [tmin, tmax].
#pragma once

#include <cstdint>

#include "model/numeric/vec3.h"

namespace ctu::cull::packet {

enum class Answer : std::uint8_t {
  Undecided,  ///< each ray must be asked
  AllMiss,
  AllHit,
};

/// Closed; lo <= hi on every axis.
struct Box {
  Vec3 lo, hi;
};

/// Closed, of any shape.
struct Triangle {
  Vec3 vertex[3];
};

/// Each vertex moves on a straight line from its place in `start` to that in `end`, all at once.
struct MovingTriangle {
  Triangle start, end;
};

/// The surface; of a negative radius the magnitude counts.
struct Sphere {
  Vec3 centre;
  float radius = 0;
};

}  // namespace ctu::cull::packet
