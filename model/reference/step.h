// A ray's event sequence: what it visited, in order, and how each visit came out. With the image it is enough
// to replay the ray through the timed unit without arithmetic; it is a function of ray, image and culling options
// alone (contract 3).
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/child_ref.h"

namespace ctu::reference {

/// One visit of a node or a leaf, 8 bytes.
///   node: lanes = box hits (bits 0..3) | survivors of the mask test (bits 4..7); detail = visiting order of the
///   survivors,
///         nearest first, 2 bits each from bit 0, then uncertain lanes in bits 8..11
///   leaf: lanes = primitives tested (all of the leaf's, or those that ray-box culling left; an any-hit ray that found
///         one leaves after the leaf); detail = bit i: primitive i became the best hit
struct Step {
  accel::ChildRef ref = 0;
  std::uint8_t dropped = 0;  ///< stack entries popped and dropped before this visit: their t0 lay beyond the best hit
  std::uint8_t lanes = 0;
  std::uint16_t detail = 0;

  bool is_leaf() const { return accel::is_leaf(ref); }
  unsigned box_hits() const { return lanes & 15u; }
  unsigned survivors() const { return lanes >> 4; }
  int survivor(int position) const { return (detail >> (2 * position)) & 3; }  ///< lane visited as number `position`
  unsigned uncertain() const { return (detail >> 8) & 15u; }
  int triangles_tested() const { return lanes; }
  unsigned became_best() const { return detail; }
  bool operator==(const Step&) const = default;
};
static_assert(sizeof(Step) == 8);

/// The steps of many rays, one after the other. Steps of ray i: [first_step[i], first_step[i+1]).
/// Keys (packed cull::CellKey, one for each box-hit lane in ascending lane order, node after node; present only for
/// designs that read tables) of ray i: [first_key[i], first_key[i+1]).
/// Primitives whose boxes the ray's box meets (bit i: primitive i; one for each leaf visited; present only with ray-box
/// culling) of ray i: [first_met[i], first_met[i+1]).
struct StepList {
  std::vector<std::uint64_t> first_step{0};
  std::vector<std::uint64_t> first_key{0};
  std::vector<std::uint64_t> first_met{0};
  std::vector<std::uint8_t> tail_dropped;  ///< entries dropped after a ray's last visit, until its stack was empty
  std::vector<Step> steps;
  std::vector<std::uint32_t> keys;
  std::vector<std::uint16_t> met;
  /// Of rays in packets only: nodes above the packet's entries that the ray visits when it walks alone.
  std::vector<std::uint16_t> spared;

  std::uint64_t rays() const { return tail_dropped.size(); }
  void clear() { *this = StepList{}; }
};

/// Work of some rays in the paper's unit: a 4-wide box test or a triangle test counts one.
struct Counts {
  std::uint64_t rays = 0;
  std::uint64_t node_visits = 0;     ///< 4-wide box tests
  std::uint64_t triangle_tests = 0;  ///< of primitives: those of spheres are among them
  std::uint64_t boxed_out = 0;       ///< primitives of visited leaves that ray-box culling left untested
  std::uint64_t leaf_visits = 0;
  std::uint64_t box_hits = 0;   ///< lanes hit by the slab test
  std::uint64_t culled = 0;     ///< ... and thrown away by the mask test
  std::uint64_t uncertain = 0;  ///< ... and passed because rounding left two candidate cells
  std::uint64_t dropped = 0;    ///< stack entries dropped at the pop

  std::uint64_t intersections() const { return node_visits + triangle_tests; }
  double intersections_per_ray() const { return rays == 0 ? 0 : double(intersections()) / double(rays); }
  double culled_share() const { return box_hits == 0 ? 0 : double(culled) / double(box_hits); }
  Counts& operator+=(const Counts& other);
};

/// Counts from recorded steps.
Counts count_steps(const StepList& list, std::uint64_t first_ray, std::uint64_t last_ray);

}  // namespace ctu::reference
