// The closed form of a row of rigid pipelines against the same row stepped cycle by cycle: links, pipes and accounts.
#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <string>
#include <vector>

#include "model/pipeline/link.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/rigid_chain.h"
#include "tests/oracle/seed.h"

namespace ctu::pipeline {
namespace {

constexpr Place kPlaces4[] = {Place::BoxTest, Place::CellLocate, Place::MaskTest, Place::ChildSort};

struct Row {
  std::vector<int> latency;
  int contexts = 0, most_occupied = 1;  ///< cycles at an entrance, at most
  double offers = 0, takes = 0;         ///< how often a token is offered and the last link looked at
};

Account account() { return {"stage", {Activity::OutputFull, Activity::BankConflict}}; }

/// One stage after the other in every cycle.
class Stepped {
 public:
  Stepped(const Row& row, Contexts& contexts)
      : contexts_(contexts), links_(row.latency.size() + 1), accounts_(row.latency.size(), account()) {
    for (const int latency : row.latency) pipes_.emplace_back(latency);
  }
  bool offer(Cycle now, const NodeToken& token, const RigidChain::Occupies& occupies) {
    if (!links_[0].can_push(now)) return false;
    links_[0].push(now, token);
    occupies_.resize(static_cast<std::size_t>(contexts_.count()));
    occupies_[token.slot] = occupies;
    return true;
  }
  /// Whether the first stage took a token.
  bool step(Cycle now) {
    bool taken = false;
    for (std::size_t i = 0; i < pipes_.size(); ++i) {
      bool entered = false;
      step_pipelined(now, links_[i], links_[i + 1], pipes_[i], accounts_[i], [&](const NodeToken& token) {
        entered = true;
        contexts_.move(token.slot, now, kPlaces4[i]);
        return Entering<NodeToken>{token, occupies_[token.slot][i]};
      });
      if (!entered && !pipes_[i].can_enter(now) && accounts_[i].current() == Activity::Busy)
        accounts_[i].correct(Activity::BankConflict);
      if (i == 0) taken = entered;
    }
    return taken;
  }
  Link<NodeToken>& exit() { return links_.back(); }
  StageAccount close(std::size_t stage) { return accounts_[stage].close(); }

 private:
  Contexts& contexts_;
  std::vector<Link<NodeToken>> links_;
  std::vector<Pipe<NodeToken>> pipes_;
  std::vector<Account> accounts_;
  std::vector<RigidChain::Occupies> occupies_;
};

class Closed {
 public:
  Closed(const Row& row, Contexts& contexts)
      : accounts_(row.latency.size(), account()), row_(stages(row, accounts_), contexts) {}
  RigidChain& row() { return row_; }
  StageAccount close(std::size_t stage, Cycle end) {
    row_.close_accounts(end);
    return accounts_[stage].close();
  }

 private:
  static std::vector<RigidChain::Stage> stages(const Row& row, std::vector<Account>& accounts) {
    std::vector<RigidChain::Stage> list;
    for (std::size_t i = 0; i < row.latency.size(); ++i)
      list.push_back({static_cast<Cycle>(row.latency[i]), kPlaces4[i], &accounts[i], Activity::BankConflict});
    return list;
  }
  std::vector<Account> accounts_;
  RigidChain row_;
};

void expect_same(const StageAccount& stepped, const StageAccount& closed) {
  EXPECT_EQ(stepped.busy, closed.busy);
  EXPECT_EQ(stepped.idle, closed.idle);
  for (std::size_t c = 0; c < stepped.stalled.size(); ++c)
    EXPECT_EQ(stepped.stalled[c].cycles, closed.stalled[c].cycles) << stepped.stalled[c].name;
}

/// Offers the same tokens to both and takes from both when it feels like it, sometimes not for long. `exit_first`: the
/// stage behind is stepped before the row.
void run(const Row& row, std::mt19937_64& random, bool exit_first) {
  Contexts stepped_contexts(row.contexts), closed_contexts(row.contexts);
  Stepped stepped(row, stepped_contexts);
  Closed closed(row, closed_contexts);
  std::deque<Slot> free;
  for (int slot = 0; slot < row.contexts; ++slot) {
    free.push_back(static_cast<Slot>(slot));
    stepped_contexts.occupy(slot, 0);
    closed_contexts.occupy(slot, 0);
  }
  std::deque<std::pair<NodeToken, RigidChain::Occupies>> offered;  // in the link before the row, for the closed form
  std::deque<Cycle> offered_in;
  std::uniform_real_distribution<double> uniform;
  double takes = row.takes;
  Cycle now = 1;
  std::size_t in_flight = 0;
  for (; now < 3000 || in_flight > 0; ++now) {
    if (now % 64 == 0) takes = uniform(random) < 0.2 ? 0.05 : row.takes;
    const bool wants = now >= 3000 || uniform(random) < takes;
    const auto take = [&] {
      ASSERT_EQ(stepped.exit().can_pop(now), closed.row().can_leave(now)) << "cycle " << now;
      if (!wants || !stepped.exit().can_pop(now)) return;
      ASSERT_EQ(stepped.exit().front(), closed.row().front()) << "cycle " << now;
      const Slot slot = stepped.exit().front().slot;
      stepped.exit().pop(now);
      closed.row().leave(now);
      stepped_contexts.move(slot, now, Place::Stack);
      closed_contexts.move(slot, now, Place::Stack);
      free.push_back(slot);
      --in_flight;
    };
    if (exit_first) take();
    const bool arrived = !offered.empty() && offered_in.front() < now;
    const bool entered = stepped.step(now);
    ASSERT_EQ(entered, arrived && closed.row().can_enter(now)) << "cycle " << now;
    if (entered) {
      closed.row().enter(now, offered.front().first, offered.front().second);
      offered.pop_front();
      offered_in.pop_front();
    }
    if (!exit_first) take();
    if (now < 2800 && !free.empty() && uniform(random) < row.offers) {
      NodeToken token{free.front(), static_cast<std::uint8_t>(random() % 16), 0, 0, 0};
      RigidChain::Occupies occupies;
      for (auto& cycles : occupies)
        cycles = static_cast<std::uint16_t>(1 + random() % static_cast<unsigned>(row.most_occupied));
      if (stepped.offer(now, token, occupies)) {
        offered.emplace_back(token, occupies);
        offered_in.push_back(now);
        free.pop_front();
        ++in_flight;
      }
    }
    ASSERT_LT(now, 20000u) << "tokens are lost";
  }
  for (std::size_t i = 0; i < row.latency.size(); ++i) {
    SCOPED_TRACE("stage " + std::to_string(i));
    expect_same(stepped.close(i), closed.close(i, now - 1));
    EXPECT_EQ(stepped_contexts.cycles_at(kPlaces4[i]), closed_contexts.cycles_at(kPlaces4[i]));
  }
}

TEST(RigidChain, every_token_comes_and_goes_in_the_cycle_that_stepping_gives_whoever_stands_in_its_way) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  for (int round = 0; round < 300 && !testing::Test::HasFailure(); ++round) {
    Row row;
    for (int stage = 1 + below(RigidChain::kMaxStages); stage > 0; --stage)
      row.latency.push_back(below(3) == 0 ? 1 : 1 + below(14));
    row.contexts = 1 + below(40);
    row.most_occupied = 1 + below(4);
    row.offers = 0.1 + 0.3 * below(4);
    row.takes = 0.1 + 0.3 * below(4);
    std::string text = "round " + std::to_string(round) + ", contexts " + std::to_string(row.contexts) + ", latencies";
    for (const int latency : row.latency) text.append(" ").append(std::to_string(latency));
    SCOPED_TRACE(text);
    run(row, random, round % 2 == 0);
  }
}

}  // namespace
}  // namespace ctu::pipeline
