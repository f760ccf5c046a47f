// What travels on the links: flat records of a few bytes. Bulky data of a ray (its registers, the slab test's times,
// ray masks) stays in its context, as in the hardware's register files, and the token names the context.
#pragma once

#include <cstdint>

#include "model/accel/bvh4.h"
#include "model/accel/child_ref.h"
#include "model/intersect/ray.h"

namespace ctu::pipeline {

using Slot = std::uint16_t;  ///< number of a context

/// A context alone: a freed one, or one whose ray is finished.
struct SlotToken {
  Slot slot = 0;
  bool operator==(const SlotToken&) const = default;
};

/// The node or leaf that a ray visits next, or the node that its packet is asked about next.
struct RefToken {
  accel::ChildRef ref = 0;
  Slot slot = 0;
  bool of_packet = false;
  bool operator==(const RefToken&) const = default;
};

/// A ray whose registers are set up. `joins`: it is valid and travels with its packet; `closes`: it is the packet's
/// last one.
struct JoinToken {
  Slot slot = 0;
  bool joins = false, closes = false;
  bool operator==(const JoinToken&) const = default;
};

/// A ray goes on alone from the entries of its packet; `last`: no other of this packet will come.
struct StartToken {
  Slot slot = 0;
  std::uint8_t packet = 0;  ///< place in the packets' registers
  bool last = false;
  bool operator==(const StartToken&) const = default;
};

/// A packet's registers are free.
struct PacketToken {
  std::uint8_t packet = 0;
  bool operator==(const PacketToken&) const = default;
};

/// A node visit on its way from the box test to the stack.
struct NodeToken {
  Slot slot = 0;
  std::uint8_t hits = 0;       ///< bit lane: hit by the slab test
  std::uint8_t survivors = 0;  ///< bit lane: passed the mask test
  std::uint8_t order = 0;      ///< lanes of the survivors, nearest first, 2 bits each
  std::uint8_t asked = 0;      ///< bit lane: hit, and its object mask is not full, so the mask test has a question
  bool operator==(const NodeToken&) const = default;
};

/// A leaf whose primitives have arrived.
struct LeafToken {
  accel::ChildRef ref = 0;
  Slot slot = 0;
  std::uint16_t met = 0xFFFF;  ///< bit i: primitive i is to be tested; bits beyond the leaf's mean nothing
  bool operator==(const LeafToken&) const = default;
};

/// The outcome of one test of a primitive when outcomes are recorded ones: nothing but its place.
struct RecordedTest {
  Slot slot = 0;
  std::uint8_t index = 0;  ///< of the primitive within its leaf
  bool last = false;       ///< of the leaf's
  bool sphere = false;
  bool is_sphere() const { return sphere; }
  bool operator==(const RecordedTest&) const = default;
};

/// The outcome of one test of a primitive when the unit computes. Of a sphere that has not been tested yet, no hit, and
/// its primitive as the leaf has it.
struct ComputedTest {
  Slot slot = 0;
  std::uint8_t index = 0;
  bool last = false;
  bool hit = false;
  intersect::Hit candidate;
  bool is_sphere() const { return (candidate.primitive & accel::LeafTriangle::kSphereBit) != 0; }
  bool operator==(const ComputedTest& other) const {
    return slot == other.slot && index == other.index && last == other.last && hit == other.hit &&
           intersect::same_bits(candidate, other.candidate);
  }
};

/// A leaf is done. `finished`: the ray wants any hit and has one.
struct LeafDone {
  Slot slot = 0;
  bool finished = false;
  bool operator==(const LeafDone&) const = default;
};

/// One line from memory, or a batch of stack entries to their place in one. Writes are not answered.
struct MemoryRequest {
  std::uint64_t address = 0;  ///< bytes; of a line, or of a batch in it
  std::uint16_t id = 0;       ///< the client's own name for it, given back in the answer
  bool write = false;
  bool operator==(const MemoryRequest&) const = default;
};

struct MemoryResponse {
  std::uint16_t id = 0;
  bool operator==(const MemoryResponse&) const = default;
};

}  // namespace ctu::pipeline
