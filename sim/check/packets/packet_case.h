// Hard cases for packet culling: a packet of rays and one primitive of each kind beside it, made by named generators.
// Many cases touch exactly, or miss by a rounding; all rays are valid.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "model/cull/packet/answer.h"
#include "model/intersect/ray.h"
#include "sim/check/case_random.h"

namespace ctu::sim::check {

struct PacketCase {
  std::vector<intersect::Ray> rays;  ///< 4 to 64
  std::vector<float> limits;         ///< where each ray may still reach, at most its tmax
  cull::packet::Box box;
  cull::packet::Triangle triangle;
  cull::packet::Sphere sphere;
  cull::packet::MovingTriangle moving;
};

struct PacketGenerator {
  std::string_view name;
  std::string_view what;  ///< one line
  void (*make)(CaseRandom& random, PacketCase& out);
};

/// All of them; a generator's place decides its random numbers.
std::span<const PacketGenerator> packet_generators();

/// Case `number` of generator number `generator`, remade from three numbers.
PacketCase make_packet_case(std::uint64_t seed, std::uint32_t generator, std::uint64_t number);

}  // namespace ctu::sim::check
