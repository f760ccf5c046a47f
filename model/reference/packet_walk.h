// Packets that walk the top of the tree once for all their rays, which then go on alone from where it ends: what a unit
// with packet_cull does, untimed.
#pragma once

#include <span>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/reference/entry_search.h"
#include "model/reference/packet_list.h"
#include "model/reference/traversal.h"

namespace ctu::reference {

/// The packets of consecutive rays, walked.
class PacketWalk {
 public:
  /// `cut` says which rays travel together, and nothing else counts of it; they walk the tree of the first one. Rays
  /// that are not valid are in a packet and have no part in it.
  PacketWalk(const accel::Bvh4& bvh, const PacketPlan& plan, std::span<const intersect::Ray> rays,
             const PacketList& cut, std::span<const RayTree> trees = {});

  const PacketList& list() const { return list_; }

  /// What every ray finds from its packet's entries on. Events are appended to `steps`, and how many nodes above the
  /// entries each ray visits when it walks alone (StepList::spared). `traversal` is one of the same tree.
  std::vector<intersect::Hit> trace(const Traversal& traversal, StepList& steps) const;

 private:
  void walk(std::size_t packet, const accel::Bvh4& bvh, const PacketPlan& plan);
  std::uint32_t tree(std::size_t packet) const { return tree_of(trees_, list_.first_ray[packet]); }
  /// The nodes that a packet has replaced by their children, or dropped.
  std::vector<std::uint32_t> replaced(std::size_t packet) const;

  std::span<const intersect::Ray> rays_;
  std::span<const RayTree> trees_;
  PacketList list_;
  std::vector<EntryList> entries_;  ///< by packet
};

/// Throws Error naming what is out of range.
void check(const PacketPlan& plan);

}  // namespace ctu::reference
