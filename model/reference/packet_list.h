// The packets of consecutive rays and what each did before its rays went on alone: a function of the rays, the image
// and the most entries a packet may have, whatever the culling design (contract 3).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "model/accel/child_ref.h"
#include "model/reference/ray_tree.h"

namespace ctu::reference {

/// How rays are made packets.
struct PacketPlan {
  int size = 0;          ///< consecutive rays, kLeastPacket .. kMostPacket; 0: there are no packets
  int most_entries = 0;  ///< 1 .. kMostEntries

  bool any() const { return size != 0; }
  bool operator==(const PacketPlan&) const = default;
};

/// A packet was asked about the children of a node.
struct PacketVisit {
  std::uint32_t node = 0;
  std::uint8_t lanes = 0;  ///< children that some ray may meet (bits 0..3) | that every ray meets (bits 4..7)

  unsigned hit() const { return lanes & 15u; }
  unsigned sure() const { return lanes >> 4; }
  bool operator==(const PacketVisit&) const = default;
};

/// Of packet p: rays [first_ray[p], first_ray[p+1]) of their block, not all of them valid; visits and entries likewise,
/// these nearest first. Where only rays are wanted visits and entries are empty.
struct PacketList {
  std::vector<std::uint32_t> first_ray{0};
  std::vector<std::uint64_t> first_visit{0}, first_entry{0};
  std::vector<PacketVisit> visits;
  std::vector<accel::ChildRef> entries;

  std::uint64_t packets() const { return first_ray.size() - 1; }
  bool walked() const { return first_visit.size() == first_ray.size(); }
  /// The packet that ray `ray` is in.
  std::uint64_t packet_of(std::uint64_t ray) const {
    return static_cast<std::uint64_t>(std::upper_bound(first_ray.begin(), first_ray.end(), ray) - first_ray.begin()) -
           1;
  }
  bool operator==(const PacketList&) const = default;
};

/// `rays` consecutive rays in packets of `size`; not walked. One is smaller before a ray of another tree, and where it
/// does not come out even at the end.
inline PacketList cut_packets(std::uint32_t rays, int size, std::span<const RayTree> trees = {}) {
  PacketList list;
  for (std::uint32_t end = 0; end < rays; list.first_ray.push_back(end)) {
    const std::uint32_t begin = end++;
    while (end < rays && end - begin < static_cast<std::uint32_t>(size) && tree_of(trees, end) == tree_of(trees, begin))
      ++end;
  }
  return list;
}

}  // namespace ctu::reference
