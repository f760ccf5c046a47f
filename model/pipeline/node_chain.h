// box_test, [cell_locate, mask_test,] and child_sort as one part of the plain engine: a node goes through their
// arithmetic when box_test takes it, and when it stands in which of them follows from rigid_chain.h. They are half of
// what moves in the unit, and rigid, so that nothing but a full link at the end can change their times.
#pragma once

#include <type_traits>

#include "model/pipeline/pipeline.h"
#include "model/pipeline/rigid_chain.h"

namespace ctu::pipeline {

/// The links of a plain unit, but for those between the stages of the chain; child_sort's to the stack is its exit.
struct ChainedWiring {
  template <class T>
  using In = std::conditional_t<std::is_same_v<T, NodeToken>, ChainExit, PlainWiring::In<T>>;
  template <class T>
  using Out = PlainWiring::Out<T>;
  template <class Stage>
  using Holder = Stage;
  template <class Stage>
  static Stage& stage(Stage& holder) {
    return holder;
  }
};

/// For units without table_fetch, which nodes leave in another order than they come.
template <class Source>
class NodeChain {
 public:
  NodeChain(UnitState<Source>& state, Stages<Source, ChainedWiring>& stages)
      : stages_(stages), row_(row_of(stages), state.contexts) {
    stages_.traversal_stack.sorted.chain = &row_;
  }

  bool step(Cycle now) {
    auto& nodes = stages_.box_test.node;
    if (!nodes.can_pop(now) || !row_.can_enter(now)) return false;
    NodeToken token = stages_.box_test.take(nodes.front()).token;
    nodes.pop(now);
    RigidChain::Occupies occupies{1, 1, 1, 1};
    if (stages_.mask_test) {
      token = pass(*stages_.cell_locate, token, occupies[1]);
      token = pass(*stages_.mask_test, token, occupies[2]);
    }
    row_.enter(now, stages_.child_sort.take(token).token, occupies);
    return true;
  }
  Cycle next_event(Cycle now) const { return row_.next_event(now); }

  RigidChain& row() { return row_; }

 private:
  template <class Stage>
  static NodeToken pass(Stage& stage, const NodeToken& token, std::uint16_t& occupies) {
    const Entering<NodeToken> entering = stage.take(token);
    occupies = static_cast<std::uint16_t>(entering.occupies);
    return entering.token;
  }

  static std::vector<RigidChain::Stage> row_of(Stages<Source, ChainedWiring>& stages) {
    std::vector<RigidChain::Stage> list;
    const auto add = [&](auto& stage, Activity occupied) {
      list.push_back({stage.latency(), stage.kPlace, &stage.account, occupied});
    };
    add(stages.box_test, Activity::Busy);
    if (stages.mask_test) {
      add(*stages.cell_locate, Activity::Busy);
      add(*stages.mask_test, Activity::BankConflict);
    }
    add(stages.child_sort, Activity::Busy);
    return list;
  }

  Stages<Source, ChainedWiring>& stages_;
  RigidChain row_;
};

}  // namespace ctu::pipeline
