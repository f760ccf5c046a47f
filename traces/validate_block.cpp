#include "traces/validate_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/cell_locate.h"
#include "model/reference/entry_search.h"

namespace ctu::traces {
namespace {

using reference::Step;

constexpr unsigned kNoOrder = 16;  // more than any set of lanes

/// By number of survivors and order byte: the set of lanes in that order, or kNoOrder where one is twice or too many
/// are named.
constexpr auto kLanesInOrder = [] {
  std::array<std::array<std::uint8_t, 256>, intersect::kLanes + 1> table{};
  for (unsigned count = 0; count < table.size(); ++count)
    for (unsigned order = 0; order < 256; ++order) {
      unsigned lanes = order >> (2 * count) != 0 ? kNoOrder : 0;
      for (unsigned i = 0; i < count; ++i) {
        const unsigned lane = 1u << (order >> (2 * i) & 3u);
        lanes |= (lanes & lane) != 0 ? kNoOrder : lane;
      }
      table[count][order] = static_cast<std::uint8_t>(lanes);
    }
  return table;
}();

/// Follows one ray after the other. Every recorded step comes by here, so a node branches on nothing but what is wrong
/// with it.
class Follower {
 public:
  Follower(const accel::Bvh4& bvh, const cull::MaskOptions& masks, const std::string& path)
      : bvh_(bvh), masks_(masks), path_(path) {}

  void follow(const reference::RayBlock& block, std::uint64_t index) {
    ray_ = block.first_ray + index;
    const reference::StepList& list = block.steps;
    const std::uint64_t first = list.first_step[index], last = list.first_step[index + 1];
    depth_ = 0;
    const accel::ChildRef root = bvh_.root(reference::tree_of(block.trees, index));
    if (intersect::is_valid(block.rays[index])) begin(block.packets, index, root);
    if (first == last) {
      if (depth_ == 1 && stack_[0] == root && block.packets.packets() == 0) refuse("a valid ray visits nothing");
      if (list.tail_dropped[index] != depth_) refuse("entries are dropped that are not on the stack, or left there");
      return;
    }
    met_ = list.met.empty() ? nullptr : list.met.data() + list.first_met[index];
    bool found = false;
    for (std::uint64_t i = first; i < last; ++i) {
      const Step& step = list.steps[i];
      if (found) refuse("an any-hit ray goes on after its hit");
      pop(step);
      if (step.is_leaf())
        found = leaf(step) && block.rays[index].kind == intersect::RayKind::AnyHit;
      else
        node(step);
    }
    if (list.tail_dropped[index] != (found ? 0 : depth_)) refuse("entries are left on the stack at the end");
  }

  /// The packet's search, answered as recorded, asks for what it visits and ends with its entries.
  void follow_packet(const reference::RayBlock& block, std::uint64_t packet, int most_entries) {
    const reference::PacketList& list = block.packets;
    ray_ = block.first_ray + list.first_ray[packet];
    const accel::ChildRef root = bvh_.root(reference::tree_of(block.trees, list.first_ray[packet]));
    bool anybody = false;
    for (std::uint64_t ray = list.first_ray[packet]; ray < list.first_ray[packet + 1]; ++ray)
      anybody |= intersect::is_valid(block.rays[ray]);
    reference::EntrySearch search;
    std::uint64_t visit = list.first_visit[packet];
    if (anybody)
      for (search.begin(most_entries, 0, root); !search.done(); ++visit) {
        if (visit == list.first_visit[packet + 1] || list.visits[visit].node != search.node())
          refuse("its packet does not visit what it must");
        const accel::Node4& node = bvh_.nodes[search.node()];
        const reference::Children children{node.child[0], node.child[1], node.child[2], node.child[3]};
        const unsigned hit = list.visits[visit].hit(), sure = list.visits[visit].sure();
        if ((hit & ~reference::lanes_of(children)) != 0) refuse("its packet meets an empty lane");
        if ((sure & ~hit) != 0) refuse("all rays of its packet meet what none may meet");
        constexpr float kAnyTime[4] = {};
        search.answer(children, hit, sure, kAnyTime);
      }
    if (visit != list.first_visit[packet + 1]) refuse("its packet visits more than it may");
    check_entries(list, packet, search.entries());
  }

  void check_keys(const std::vector<std::uint32_t>& keys) const {
    bool meaningless = false, outside = false;
    for (const std::uint32_t packed : keys) {  // without branches it becomes vector instructions
      const cull::CellKey key{packed};
      const bool asked = !key.uncertain();  // an uncertain one says nothing and is not looked up
      bool beyond = false;
      for (int axis = 0; axis < 3; ++axis)
        beyond |= (key.begin(axis) >= masks_.ray_resolution) | (key.end(axis) >= masks_.ray_resolution);
      meaningless |= asked & ((packed >> 30) != 0);
      outside |= asked & beyond;
    }
    if (meaningless) refuse("a key has bits that mean nothing");
    if (outside) refuse(fmt::format("a key lies outside the grid of R_ray = {}", masks_.ray_resolution));
  }

 private:
  /// The same entries in any order: which are nearer is for arithmetic to say.
  void check_entries(const reference::PacketList& list, std::uint64_t packet, const reference::EntryList& found) const {
    const auto at = [](std::uint64_t i) { return static_cast<std::ptrdiff_t>(i); };
    std::vector<accel::ChildRef> recorded(list.entries.begin() + at(list.first_entry[packet]),
                                          list.entries.begin() + at(list.first_entry[packet + 1]));
    std::vector<accel::ChildRef> right;
    for (int i = 0; i < found.count(); ++i) right.push_back(found[i].ref);
    std::sort(recorded.begin(), recorded.end());
    std::sort(right.begin(), right.end());
    if (recorded != right) refuse("its packet ends with other entries than its visits give");
  }

  /// The stack of a ray that begins: the root, or the entries of its packet.
  void begin(const reference::PacketList& list, std::uint64_t index, accel::ChildRef root) {
    if (list.packets() == 0) {
      stack_[depth_++] = root;
      return;
    }
    const std::uint64_t packet = list.packet_of(index);
    for (std::uint64_t i = list.first_entry[packet + 1]; i-- > list.first_entry[packet];)
      stack_[depth_++] = list.entries[i];
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(path_, fmt::format("steps: ray {}: {}", ray_, what), "record the trace again");
  }

  void pop(const Step& step) {
    if (depth_ <= step.dropped) refuse("the stack has no entry left");
    depth_ -= step.dropped + std::size_t{1};
    if (stack_[depth_] != step.ref) refuse("a visit is not what lies on the stack");
  }

  void node(const Step& step) {
    const accel::Node4& node = bvh_.nodes[step.ref];
    const unsigned survivors = step.survivors();
    if ((survivors & ~step.box_hits()) != 0) refuse("a lane survives that the box test missed");
    if ((step.uncertain() & ~survivors) != 0 || (step.detail >> 12) != 0) refuse("an uncertain lane does not survive");
    unsigned empty = 0;
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      empty |= unsigned{node.child[lane] == accel::kEmptyChild} << lane;
    if ((step.box_hits() & empty) != 0) refuse("an empty lane is hit");
    const unsigned count = static_cast<unsigned>(std::popcount(survivors)), order = step.detail & 0xFFu;
    if (kLanesInOrder[count][order] != survivors) refuse("the order is not one of the survivors");
    if (stack_.size() < depth_ + intersect::kLanes) stack_.resize(2 * stack_.size());
    // Farthest first; of four entries written those behind the last survivor do not count.
    const unsigned farthest_first = order << (2 * (intersect::kLanes - count));
    for (int i = 0; i < intersect::kLanes; ++i)
      stack_[depth_ + static_cast<std::size_t>(i)] =
          node.child[farthest_first >> (2 * (intersect::kLanes - 1 - i)) & 3u];
    depth_ += count;
  }

  bool leaf(const Step& step) {
    const int count = accel::leaf_count(step.ref);
    const unsigned all = (1u << count) - 1, tested = met_ == nullptr ? all : *met_++;
    if ((tested & ~all) != 0) refuse("a box is met of a primitive that the leaf does not have");
    if (step.triangles_tested() != std::popcount(tested)) refuse("not all triangles of a leaf are tested");
    if ((step.became_best() & ~tested) != 0) refuse("a triangle is hit that is not tested");
    return step.became_best() != 0;
  }

  const accel::Bvh4& bvh_;
  const cull::MaskOptions& masks_;
  const std::string& path_;
  std::uint64_t ray_ = 0;
  const std::uint16_t* met_ = nullptr;  ///< of the ray's next leaf; null without ray-box culling
  std::vector<accel::ChildRef> stack_ = std::vector<accel::ChildRef>(64);
  std::size_t depth_ = 0;  ///< entries on it
};

}  // namespace

void validate_block(const reference::RayBlock& block, const accel::Bvh4& bvh, const cull::MaskOptions& masks,
                    const std::string& path, const reference::PacketPlan& packets) {
  if (block.steps.rays() == 0) return;
  Follower follower(bvh, masks, path);
  for (std::uint64_t packet = 0; packet < block.packets.packets(); ++packet)
    follower.follow_packet(block, packet, packets.most_entries);
  for (std::uint64_t ray = 0; ray < block.rays.size(); ++ray) follower.follow(block, ray);
  follower.check_keys(block.steps.keys);
}

}  // namespace ctu::traces
