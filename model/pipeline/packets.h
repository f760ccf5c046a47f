// The registers of the packets under way: who is in each, and how far its search for entries has come. Two stages touch
// them, never at once: packet_cull until it hands the packet's rays on, traversal_stack from then until it hands the
// packet back.
#pragma once

#include <cstdint>
#include <vector>

#include "model/pipeline/tokens.h"
#include "model/reference/entry_search.h"

namespace ctu::pipeline {

struct Packet {
  std::vector<Slot> members;  ///< contexts of its rays, in their order; the first one's is the leader's
  reference::EntrySearch search;
  reference::EntryList entries;  ///< when the search is done
  std::uint32_t visits = 0;

  Slot leader() const { return members.front(); }
};

class Packets {
 public:
  explicit Packets(int count) : packets_(static_cast<std::size_t>(count)) {}
  int count() const { return static_cast<int>(packets_.size()); }
  Packet& operator[](int packet) { return packets_[static_cast<std::size_t>(packet)]; }
  const Packet& operator[](int packet) const { return packets_[static_cast<std::size_t>(packet)]; }

 private:
  std::vector<Packet> packets_;
};

}  // namespace ctu::pipeline
