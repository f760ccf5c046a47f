// The search for the places where the rays of a packet go on alone: the top of the tree, walked once for all of them.
//
// A first-in first-out queue of nodes begins with the root of the packet's tree. The packet is asked about the children
// of the node at its head. Those that some ray may meet take the node's place, if none of them is a leaf, if all of
// them but one at most are met by every ray, and if queue and entries then hold no more than `most_entries`; else the
// node becomes an entry. A node whose children all rays miss is dropped for all.
//
// Why at most one in doubt: a ray that comes to the node alone asks for it, and then for those children that it meets.
// From the children's entries it asks for all of them. So it asks for no more when it misses one of them at most.
// Why nothing is lost: queue and entries together always cover every leaf that a ray of the packet can meet. Why leaves
// are no entries themselves: so each ray asks for its own box before it tests a leaf, and tests none that it would not
// test alone without masks. Its hit is the same, but where two primitives meet at one place: which of them rounding
// puts first may go by the order in which the ray comes to them, and that is another one.
//
// Reference and unit run this one search; what answers it is the caller's.
#pragma once

#include <array>
#include <bit>

#include "model/accel/bvh4.h"
#include "model/reference/entry_list.h"

namespace ctu::reference {

using Children = std::array<accel::ChildRef, 4>;

/// Bit lane: there is a child.
inline unsigned lanes_of(const Children& children) {
  unsigned lanes = 0;
  for (unsigned lane = 0; lane < 4; ++lane) lanes |= unsigned{children[lane] != accel::kEmptyChild} << lane;
  return lanes;
}

class EntrySearch {
 public:
  /// `begins`: not after the begin of any ray; `root`: of the tree that all rays of the packet walk.
  void begin(int most_entries, float begins, accel::ChildRef root) {
    most_ = most_entries;
    entries_.clear();
    head_ = tail_ = 0;
    push({root, begins});
  }
  bool done() const { return head_ == tail_; }
  /// The node that the packet is asked about next.
  accel::ChildRef node() const { return at(head_).ref; }

  /// `children` of node(); those that some ray may meet (`hit`) and that every ray meets (`sure`), bit lane, and t0
  /// when at the earliest. Whether node() has become an entry.
  bool answer(const Children& children, unsigned hit, unsigned sure, const float* t0) {
    const Entry node = at(head_++);
    const int places = static_cast<int>(tail_ - head_) + entries_.count() + std::popcount(hit);
    bool stays = places > most_ || std::popcount(hit & ~sure) > 1;
    for (unsigned lane = 0; lane < 4; ++lane) stays |= (hit >> lane & 1) != 0 && accel::is_leaf(children[lane]);
    if (stays) {
      entries_.add(node);
    } else {
      for (unsigned lane = 0; lane < 4; ++lane)
        if ((hit >> lane & 1) != 0) push({children[lane], t0[lane]});
    }
    return stays;
  }

  const EntryList& entries() const { return entries_; }

 private:
  const Entry& at(unsigned number) const { return queue_[number % kMostEntries]; }
  void push(const Entry& entry) { queue_[tail_++ % kMostEntries] = entry; }

  int most_ = 1;
  EntryList entries_;
  std::array<Entry, kMostEntries> queue_;
  unsigned head_ = 0, tail_ = 0;
};

}  // namespace ctu::reference
