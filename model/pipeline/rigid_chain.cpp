#include "model/pipeline/rigid_chain.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace ctu::pipeline {

// The ring holds the tokens of the row, at most one a context, and behind the oldest as many as can have been in a
// stage together with it.
RigidChain::RigidChain(std::vector<Stage> stages, Contexts& contexts)
    : count_(static_cast<int>(stages.size())),
      contexts_(contexts),
      passages_(std::bit_ceil(static_cast<std::size_t>(std::max(4, 2 * contexts.count())))),
      mask_(static_cast<Number>(passages_.size() - 1)) {
  std::copy(stages.begin(), stages.end(), stages_.begin());
}

void RigidChain::enter(Cycle now, const NodeToken& token, const Occupies& occupies) {
  contexts_.move(token.slot, now, stages_[0].place);
  Passage& passage = at(tail_);
  passage.token = token;
  passage.occupies = occupies;
  passage.enters[0] = now;
  for (int i = 0; i < count_; ++i) settle(tail_, i, 0);
  ++tail_;
  const Cycle leaves = passage.leaves[static_cast<std::size_t>(count_ - 1)];
  if (tail_ - head_ == 1) head_ready_ = leaves + 1;
  if (tail_ - head_ == 3) third_leaves_ = leaves;
}

/// The times of a token in one stage, from those of the ones before it and its own in the stage before. Whether any of
/// them is another one than it was.
inline bool RigidChain::settle(Number n, int stage, Cycle room_behind) {
  Passage& passage = at(n);
  const Passage& before = at(n - 1);
  const auto i = static_cast<std::size_t>(stage);
  const Entry entered = entry(n, stage, i == 0 ? passage.enters[0] : passage.leaves[i - 1] + 1);
  const Cycle due =
      entered.cycle + passage.occupies[i] - 1 + stages_[i].latency + before.still_at_exit[i] - entered.still;
  const Cycle room = stage + 1 < count_ ? at(n - 2).enters[i + 1] + 1 : room_behind;
  const Cycle leaves = std::max(due, room), still_at_exit = before.still_at_exit[i] + leaves - due;
  const bool changes = passage.enters[i] != entered.cycle || passage.still_at_entry[i] != entered.still ||
                       passage.leaves[i] != leaves || passage.still_at_exit[i] != still_at_exit;
  passage.enters[i] = entered.cycle;
  passage.still_at_entry[i] = entered.still;
  passage.leaves[i] = leaves;
  passage.still_at_exit[i] = still_at_exit;
  passage.last_stop[i] = leaves == due ? before.last_stop[i] : leaves;
  return changes;
}

/// The same as entry() where the stage stands still when token `n` comes, or will.
RigidChain::Entry RigidChain::entry_among_stops(Number n, int stage, Cycle arrival) const {
  const auto i = static_cast<std::size_t>(stage);
  const Passage& before = at(n - 1);
  const Cycle free = before.enters[i] + before.occupies[i] - before.still_at_entry[i];
  Entry entry{std::max(arrival, free + before.still_at_entry[i]), before.still_at_entry[i]};
  Number j = n - 1;
  while (at(j - 1).leaves[i] > before.enters[i]) --j;  // the oldest that was in the stage with it
  for (; j != n; ++j) {
    const Passage& stop = at(j);
    const Cycle stood = stop.still_at_exit[i] - at(j - 1).still_at_exit[i];
    if (stood == 0) continue;
    if (stop.leaves[i] - stood > entry.cycle) break;
    entry = {std::max({arrival, free + stop.still_at_exit[i], stop.leaves[i]}), stop.still_at_exit[i]};
  }
  return entry;
}

/// The same again, from a stage on; the first one in which something is different now, or count_.
int RigidChain::settle_again(Number n, int from, Cycle room_behind) {
  int changed = count_;
  for (int stage = from; stage < count_; ++stage)
    if (settle(n, stage, room_behind)) changed = std::min(changed, stage);
  return changed;
}

/// The last link has room for token `first` in cycle `room_behind` and not before. What is different by that spreads to
/// later tokens, and by full links one stage to the front with each token; no further than to tokens that come to a
/// stage when the last one concerned has left it.
void RigidChain::settle_from(Number first, Cycle room_behind) {
  int lowest = settle_again(first, count_ - 1, room_behind);
  Number last_changed = first;
  for (Number n = first + 1; n != tail_; ++n) {
    const int from = std::max(lowest - 1, 0);
    if (n - last_changed > 2 && left_before(last_changed, n - 1, from)) break;
    const int changed = settle_again(n, from, 0);
    if (changed < count_) last_changed = n;
    lowest = std::min(lowest, changed);
  }
  find_third();
}

/// Whether token `n` has left each stage from `from` on when `later` comes to it.
bool RigidChain::left_before(Number n, Number later, int from) const {
  for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(count_); ++i)
    if (at(n).leaves[i] > at(later).enters[i]) return false;
  return true;
}

void RigidChain::find_third() {
  third_leaves_ = tail_ - head_ < 3 ? kNever : at(head_ + 2).leaves[static_cast<std::size_t>(count_ - 1)];
}

void RigidChain::leave(Cycle now) {
  const Passage& passage = at(head_);
  const Passage& before = at(head_ - 1);
  const auto last = static_cast<std::size_t>(count_ - 1);
  for (std::size_t i = 0; i < kMaxStages; ++i) {  // all of them at once; what is behind the last one is not used
    const Cycle behind = passage.leaves[i] + 1;
    const Cycle stood = passage.still_at_exit[i] - before.still_at_exit[i], again = passage.occupies[i] - Cycle{1};
    stood_[i] += stood;
    occupied_again_[i] += again;
    busy_[i] += behind - std::max(passage.enters[i], busy_until_[i]) - stood - again;
    busy_until_[i] = behind;
  }
  for (std::size_t i = 0; i + 1 < kMaxStages; ++i) stayed_[i] += passage.enters[i + 1] - passage.enters[i];
  contexts_.stay(passage.token.slot) = {passage.enters[last], stages_[last].place};
  ++head_;
  head_ready_ = head_ == tail_ ? kNever : at(head_).leaves[last] + 1;
  find_third();
  if (tail_ - head_ >= 2 && at(head_ + 1).leaves[last] <= now) settle_from(head_ + 1, now + 1);
}

Cycle RigidChain::next_event(Cycle now) const {
  Cycle next = head_ready_ > now ? head_ready_ : kNever;
  const Cycle takes = entry(tail_, 0, now).cycle;
  if (takes > now) next = earlier(next, takes);
  return next;
}

void RigidChain::close_accounts(Cycle end) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    const Stage& stage = stages_[i];
    stage.account->add(Activity::OutputFull, std::exchange(stood_[i], 0));
    stage.account->add(stage.occupied, std::exchange(occupied_again_[i], 0));
    stage.account->add(Activity::Busy, std::exchange(busy_[i], 0));
    stage.account->rest_idle(end);
    if (i + 1 < static_cast<std::size_t>(count_)) contexts_.charge(stage.place, std::exchange(stayed_[i], 0));
  }
}

Activity RigidChain::shown_activity(int stage) const {
  const auto i = static_cast<std::size_t>(stage);
  for (Number n = head_; n != tail_; ++n) {
    const Passage& passage = at(n);
    if (passage.enters[i] > shown_ || passage.leaves[i] < shown_) continue;
    const Cycle stood = passage.still_at_exit[i] - at(n - 1).still_at_exit[i];
    return passage.leaves[i] > shown_ && passage.leaves[i] - stood <= shown_ ? Activity::OutputFull : Activity::Busy;
  }
  return Activity::Idle;
}

void RigidChain::show(Cycle now) {
  if (third_leaves_ <= now) settle_from(head_ + 2, now + 1);
  shown_ = now;
  for (int i = 0; i < count_; ++i) stages_[static_cast<std::size_t>(i)].account->show(shown_activity(i));
  for (Number n = head_; n != tail_; ++n) {
    Stay& stay = contexts_.stay(at(n).token.slot);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_) && at(n).enters[i] <= now; ++i)
      stay = {at(n).enters[i], stages_[i].place};
  }
}

int RigidChain::occupancy(int stage) const {
  const auto i = static_cast<std::size_t>(stage);
  int entries = 0;
  for (Number n = head_; n != tail_; ++n) {
    const bool taken = stage + 1 < count_ && at(n).enters[i + 1] < shown_;
    entries += at(n).leaves[i] < shown_ && !taken;
  }
  return entries;
}

}  // namespace ctu::pipeline
