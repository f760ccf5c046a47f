// How long ago was a line used, in other lines used since? That number decides whether a cache that replaces the least
// recently used line still has it, for all sizes of the cache at once (Mattson, Gecsei, Slutz, Traiger 1970,
// "Evaluation techniques for storage hierarchies"). Only which of a few capacities would have held the line is kept, as
// borders in the list of lines, so that a use costs a step for each border that it moves (Kim, Hill, Wood 1991,
// "Implementing stack simulation for highly-associative memories").
#pragma once

#include <cstdint>
#include <vector>

namespace ctu::ladder {

/// Capacities in lines, two to an octave: 8, 11, 16, 23, ... 131072.
inline constexpr int kCapacities = 29;
/// A line in group g was held by a cache of capacity(g) lines, but not by one of capacity(g - 1); group kCapacities by
/// none of them, as a line never used before.
inline constexpr int kGroups = kCapacities + 1;

constexpr std::uint32_t capacity(int group) {
  const std::uint32_t octave = 8u << (group / 2);
  return group % 2 == 0 ? octave : octave * 181 / 128;
}

class LineStack {
 public:
  using LineNumber = std::uint64_t;

  /// Lines are numbered below `lines`.
  explicit LineStack(std::uint64_t lines) : place_of_(lines, 0), nodes_(1) {}

  /// What a use of a line finds.
  struct Use {
    int group;            ///< where it was
    std::uint32_t place;  ///< a number of its own, small and dense, from 0 on
  };

  /// The line becomes the most recently used one.
  Use use(LineNumber line) {
    std::uint32_t node = place_of_[line];
    if (node == 0) {
      node = place_of_[line] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back({});
      ++count_;
      push_front(node, kCapacities);
      return {kCapacities, node - 1};
    }
    const int group = nodes_[node].group;
    if (node != first_) {
      if (group < kCapacities && last_[group] == node) last_[group] = nodes_[node].previous;
      unlink(node);
      push_front(node, group);
    }
    return {group, node - 1};
  }
  /// Lines used at least once.
  std::uint32_t distinct() const { return count_; }

 private:
  struct Node {
    std::uint32_t previous = 0, next = 0;  // towards the front, towards the back; 0: none
    std::uint8_t group = 0;
  };

  void unlink(std::uint32_t node) {
    const Node& n = nodes_[node];
    nodes_[n.previous].next = n.next;  // node 0 takes what nobody reads
    nodes_[n.next].previous = n.previous;
  }

  /// In front of all others; the groups that stood before the one it left give their last line to the next one.
  void push_front(std::uint32_t node, int left) {
    nodes_[node].previous = 0;
    nodes_[node].next = first_;
    nodes_[node].group = 0;
    if (first_ != 0) nodes_[first_].previous = node;
    first_ = node;
    if (size_[0] == 0) last_[0] = node;
    ++size_[0];
    if (left < kCapacities) --size_[left];
    for (int g = 0; g < left && size_[g] > room(g); ++g) {
      const std::uint32_t moved = last_[g];
      last_[g] = nodes_[moved].previous;
      --size_[g];
      nodes_[moved].group = static_cast<std::uint8_t>(g + 1);
      if (g + 1 == kCapacities) break;
      if (size_[g + 1]++ == 0) last_[g + 1] = moved;
    }
  }
  static std::uint32_t room(int group) { return group == 0 ? capacity(0) : capacity(group) - capacity(group - 1); }

  std::vector<std::uint32_t> place_of_;  // of each line; 0: not used yet
  std::vector<Node> nodes_;              // number 0 is nobody
  std::uint32_t first_ = 0, count_ = 0;
  std::uint32_t last_[kCapacities] = {}, size_[kCapacities] = {};
};

}  // namespace ctu::ladder
