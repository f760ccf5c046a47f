// A row of rigid pipelines (pipe.h) joined by links, in closed form: when a token enters and leaves each of them
// follows from when the tokens before it did, so it is settled once, when the token enters the row, and not looked for
// in every cycle. With occupies o, latency l, and the cycles f by which a pipeline stood still, for token n in stage i
//
//   enters(i, n) = the first cycle >= leaves(i-1, n) + 1 in which the entrance is free (token n-1 has had its o cycles)
//                  and the stage does not stand still
//   due(i, n)    = enters(i, n) + o - 1 + l + f since then
//   leaves(i, n) = max(due(i, n), enters(i+1, n-2) + 1), as the link behind has two places
//
// Only how long the last link is full is not known before: that the one behind takes tokens as they come is assumed,
// and where it does not, the tokens that stand behind it are settled again. What has passed cannot change by that.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/pipeline/accounting.h"
#include "model/pipeline/context.h"
#include "model/pipeline/cycle.h"
#include "model/pipeline/tokens.h"

namespace ctu::pipeline {

class RigidChain {
 public:
  static constexpr int kMaxStages = 4;

  struct Stage {
    Cycle latency = 1;
    Place place{};                       ///< of a ray from its entrance on
    Account* account = nullptr;          ///< charged when a token leaves the row
    Activity occupied = Activity::Busy;  ///< what a cycle counts as in which a token keeps the entrance once more
  };
  /// How long a token keeps the entrance of each stage, in cycles.
  using Occupies = std::array<std::uint16_t, kMaxStages>;

  /// At most kMaxStages, in order.
  RigidChain(std::vector<Stage> stages, Contexts& contexts);

  /// The first stage can take a token in this cycle.
  bool can_enter(Cycle now) {
    if (third_leaves_ <= now) settle_from(head_ + 2, now + 1);
    return entry(tail_, 0, now).cycle == now;
  }
  /// `token` as it leaves the row.
  void enter(Cycle now, const NodeToken& token, const Occupies& occupies);

  /// A token stands in the last link.
  bool can_leave(Cycle now) const { return head_ready_ <= now; }
  const NodeToken& front() const { return at(head_).token; }
  /// Takes it; its way is in the accounts when they are closed.
  void leave(Cycle now);

  /// The next cycle after `now` in which a token can leave that could not before, or the first stage stands no more.
  Cycle next_event(Cycle now) const;

  /// Charges accounts and rays' places with the ways of all tokens that have left. Of `end` cycles, those of which a
  /// stage knows nothing were idle.
  void close_accounts(Cycle end);

  /// For a report: brings the rays' places and what the stages are up to date.
  void show(Cycle now);
  /// Entries at the start of the cycle shown, of the link behind a stage.
  int occupancy(int stage) const;

 private:
  /// Tokens are numbered as they enter.
  using Number = std::uint32_t;

  using Times = std::array<Cycle, kMaxStages>;  ///< by stage

  /// When the token enters and leaves, and for how many cycles the stage had stood still until then.
  struct Passage {
    NodeToken token;
    Occupies occupies{};
    Times enters{}, leaves{}, still_at_entry{}, still_at_exit{};
    Times last_stop{};  ///< end of the last time the stage stood still because this token or one before could not leave
  };
  struct Entry {
    Cycle cycle, still;
  };

  Passage& at(Number number) { return passages_[number & mask_]; }
  const Passage& at(Number number) const { return passages_[number & mask_]; }

  /// When a stage takes token `n` that comes to it in cycle `arrival`.
  Entry entry(Number n, int stage, Cycle arrival) const {
    const Passage& before = at(n - 1);
    const auto i = static_cast<std::size_t>(stage);
    const Cycle free = before.enters[i] + before.occupies[i];
    const Cycle stood = before.still_at_exit[i] - before.still_at_entry[i];
    if (stood != 0 && before.last_stop[i] > arrival) [[unlikely]]
      return entry_among_stops(n, stage, arrival);
    return {free + stood > arrival ? free + stood : arrival, before.still_at_exit[i]};
  }
  Entry entry_among_stops(Number n, int stage, Cycle arrival) const;
  bool settle(Number n, int stage, Cycle room_behind);
  int settle_again(Number n, int from, Cycle room_behind);
  bool left_before(Number n, Number later, int from) const;
  void settle_from(Number first, Cycle room_behind);
  void find_third();
  Activity shown_activity(int stage) const;

  int count_;
  std::array<Stage, kMaxStages> stages_{};
  Times busy_until_{};                         ///< what is behind has been added to the sums:
  Times busy_{}, stood_{}, occupied_again_{};  ///< cycles of the stage
  Times stayed_{};                             ///< cycles of rays, of all stages but the last
  Contexts& contexts_;
  std::vector<Passage> passages_;      ///< a ring
  Number mask_, head_ = 2, tail_ = 2;  ///< two blank ones stand before the first token
  Cycle head_ready_ = kNever;          ///< the oldest token can be taken from then on
  Cycle third_leaves_ = kNever;        ///< where the last link has room for the third oldest one by then
  Cycle shown_ = 0;
};

/// The port of the stage behind the row.
struct ChainExit {
  RigidChain* chain = nullptr;
  bool can_pop(Cycle now) const { return chain->can_leave(now); }
  const NodeToken& front() const { return chain->front(); }
  void pop(Cycle now) { chain->leave(now); }
};

}  // namespace ctu::pipeline
