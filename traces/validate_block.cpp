#include "traces/validate_block.h"

#include <bit>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/cell_locate.h"

namespace ctu::traces {
namespace {

using reference::Step;

/// Follows one ray after the other.
class Follower {
 public:
  Follower(const accel::Bvh4& bvh, const cull::MaskOptions& masks, const std::string& path)
      : bvh_(bvh), masks_(masks), path_(path) {}

  void follow(const reference::RayBlock& block, std::uint64_t index) {
    ray_ = block.first_ray + index;
    const reference::StepList& list = block.steps;
    const std::uint64_t first = list.first_step[index], last = list.first_step[index + 1];
    if (first == last) {
      if (intersect::is_valid(block.rays[index])) refuse("a valid ray visits nothing");
      if (list.tail_dropped[index] != 0) refuse("entries are dropped from an empty stack");
      return;
    }
    stack_.assign(1, 0);
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
    if (list.tail_dropped[index] != (found ? 0 : stack_.size())) refuse("entries are left on the stack at the end");
  }

  void check_key(std::uint32_t packed) const {
    const cull::CellKey key{packed};
    if (key.uncertain()) return;  // it says nothing and is not looked up
    if ((packed >> 30) != 0) refuse("a key has bits that mean nothing");
    for (int axis = 0; axis < 3; ++axis)
      if (key.begin(axis) >= masks_.ray_resolution || key.end(axis) >= masks_.ray_resolution)
        refuse(fmt::format("a key lies outside the grid of R_ray = {}", masks_.ray_resolution));
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(path_, fmt::format("steps: ray {}: {}", ray_, what), "record the trace again");
  }

  void pop(const Step& step) {
    if (stack_.size() <= step.dropped) refuse("the stack has no entry left");
    stack_.resize(stack_.size() - step.dropped);
    if (stack_.back() != step.ref) refuse("a visit is not what lies on the stack");
    stack_.pop_back();
  }

  void node(const Step& step) {
    const accel::Node4& node = bvh_.nodes[step.ref];
    const unsigned survivors = step.survivors();
    if ((survivors & ~step.box_hits()) != 0) refuse("a lane survives that the box test missed");
    if ((step.uncertain() & ~survivors) != 0 || (step.detail >> 12) != 0) refuse("an uncertain lane does not survive");
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      if (((step.box_hits() >> lane) & 1u) != 0 && node.child[lane] == accel::kEmptyChild)
        refuse("an empty lane is hit");
    const int count = std::popcount(survivors);
    unsigned ordered = 0;
    for (int i = 0; i < count; ++i) ordered |= 1u << step.survivor(i);
    if (ordered != survivors || (step.detail & 0xFFu) >> (2 * count) != 0)
      refuse("the order is not one of the survivors");
    for (int i = count - 1; i >= 0; --i) stack_.push_back(node.child[step.survivor(i)]);
  }

  bool leaf(const Step& step) const {
    const int count = accel::leaf_count(step.ref);
    if (step.triangles_tested() != count) refuse("not all triangles of a leaf are tested");
    if ((step.became_best() >> count) != 0) refuse("a triangle is hit that the leaf does not have");
    return step.became_best() != 0;
  }

  const accel::Bvh4& bvh_;
  const cull::MaskOptions& masks_;
  const std::string& path_;
  std::uint64_t ray_ = 0;
  std::vector<accel::ChildRef> stack_;
};

}  // namespace

void validate_block(const reference::RayBlock& block, const accel::Bvh4& bvh, const cull::MaskOptions& masks,
                    const std::string& path) {
  if (block.steps.rays() == 0) return;
  Follower follower(bvh, masks, path);
  for (std::uint64_t ray = 0; ray < block.rays.size(); ++ray) follower.follow(block, ray);
  for (const std::uint32_t key : block.steps.keys) follower.check_key(key);
}

}  // namespace ctu::traces
