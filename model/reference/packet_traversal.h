// The untimed traversal of a packet: its rays go through the tree each in its own order, and those that have come to
// the same node are asked about together first. What all of them miss, none is asked about.
//
// A ray visits exactly what it would visit alone, without the children and primitives that it misses in exact
// arithmetic: so it finds the same hit, bit for bit, but for a near-miss (a primitive that only its rounded test
// accepts), and what one ray visits does not depend on when the others come by.
// Source: Boulos, Wald, Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets"; splitting:
// section 7.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "model/accel/bvh4.h"
#include "model/cull/packet/method.h"
#include "model/intersect/ray.h"
#include "model/reference/node_test.h"
#include "model/reference/packet_forming.h"

namespace ctu::reference {

struct PacketOptions {
  cull::packet::Method method = cull::packet::Method::AxisInterval;
  bool culls = true;   ///< false: packets are formed, split and counted, and every ray is asked about everything
  int least_rays = 4;  ///< fewer that have come to a node together go on alone there
  bool splits = true;  ///< in two, where a subtree lies inside the packet, down to packets of kLeastPacket
};

/// A 4-wide test of a ray and a node, or a test of a ray and a primitive, counts one, as in Counts.
struct PacketCounts {
  std::uint64_t rays = 0, packets = 0;
  std::uint64_t splits = 0;  ///< of packets that have come to a node

  std::uint64_t node_visits = 0, leaf_visits = 0;   ///< by packets; those of rays alone are not among them
  std::uint64_t box_questions = 0, box_misses = 0;  ///< to a packet about a child, and all-miss
  std::uint64_t primitive_questions = 0, primitive_misses = 0;

  std::uint64_t node_tests = 0, primitive_tests = 0;              ///< by single rays
  std::uint64_t alone_node_tests = 0, alone_primitive_tests = 0;  ///< of these, by rays that have left their packet
  std::uint64_t saved_node_tests = 0, saved_primitive_tests = 0;  ///< of rays for which a packet was asked
  std::uint64_t box_tests = 0, saved_box_tests = 0;  ///< the same of single boxes: a node's that were (not) dropped

  std::uint64_t questions() const { return box_questions + primitive_questions; }
  std::uint64_t tests() const { return node_tests + primitive_tests; }
  PacketCounts& operator+=(const PacketCounts& other);
};

/// Rays of a packet that have come to the same place.
struct PacketPlace {
  std::span<const intersect::Ray> rays;  ///< of the packet, or the part of it that they travel with
  std::uint32_t part = 0;                ///< which part: numbers of a packet's parts differ
  std::span<const float> limits;         ///< how far each of `rays` may still reach; -inf: it is not here
};

/// Sees every question that a packet is asked, before it is answered.
class PacketObserver {
 public:
  virtual ~PacketObserver() = default;
  virtual void begin_packet() = 0;
  virtual void box(const PacketPlace& place, const cull::packet::Box& box) = 0;
  virtual void triangle(const PacketPlace& place, const cull::packet::Triangle& triangle) = 0;
  virtual void sphere(const PacketPlace& place, const cull::packet::Sphere& sphere) = 0;
};

/// Traces packet by packet; const after construction, so threads share it.
class PacketTraversal {
 public:
  /// `masks` may be null when the tester's design is none. All three must outlive this.
  PacketTraversal(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester,
                  const PacketOptions& options);

  /// One packet of 1 to kMostPacket valid rays: hits[i] is what rays[i] finds.
  void trace(std::span<const intersect::Ray> rays, std::span<intersect::Hit> hits, PacketCounts& counts,
             PacketObserver* observer = nullptr) const;

  /// All rays, in packets formed as `forming` says; rays that are not valid miss.
  void trace(std::span<const intersect::Ray> rays, const FormingOptions& forming, std::span<intersect::Hit> hits,
             PacketCounts& counts, PacketObserver* observer = nullptr) const;

 private:
  NodeTest test_node_;
  PacketOptions options_;
};

}  // namespace ctu::reference
