// Memory as banks with open rows: channels, row activation, precharge, column access, a data bus for each channel, and
// refresh. One decision for each data slot of a channel instead of one for each command: among the waiting requests
// the one whose column access can come earliest, unless the oldest has waited longer than the age cap. The request's
// activation and precharge are placed in time then and there. All times in cycles of the unit's clock.
//
// Closed forms (tests/pipeline/memory_test.cpp): an unloaded random read takes front + tRP + tRCD + tCL + burst when
// its bank has another row open, front + tCL + burst when its row is open; streaming keeps the bus busy.
#pragma once

#include <cstdint>
#include <vector>

#include "model/pipeline/cycle.h"
#include "model/pipeline/memory_client.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

class BankedMemory {
 public:
  /// `most_reads`: that can be under way at once.
  explicit BankedMemory(const MemoryConfig& config, std::size_t most_reads = kMaxOutstandingReads);

  /// Room in the queue of the channel that the address belongs to.
  bool can_accept(std::uint64_t address) const { return channels_[channel_of(address)].queue.size() < queue_depth_; }
  void accept(Cycle now, const ClientRequest& request);
  /// One cycle: each channel decides about its next data slot if it is time to. Whether one did.
  bool work(Cycle now);
  /// Whether an answer is ready or work is to be done.
  bool due(Cycle now) const { return earlier(next_answer_, next_decision_) <= now; }
  bool answer_ready(Cycle now) const { return next_answer_ <= now; }
  const ClientAnswer& answer() const {
    return channels_[answering_].answers[channels_[answering_].first_answer].answer;
  }
  void take_answer();
  Cycle next_event(Cycle now) const;
  bool empty() const { return waiting_ == 0 && unanswered_ == 0; }

  struct Counters {
    std::uint64_t reads = 0, writes = 0, row_hits = 0, refreshes = 0, bus_cycles = 0;
  };
  const Counters& counters() const { return counters_; }

 private:
  struct Waiting {
    ClientRequest request;
    Cycle arrived;
    std::uint32_t bank;
    std::uint64_t row;
  };
  struct Bank {
    static constexpr std::uint64_t kClosed = ~std::uint64_t{0};
    std::uint64_t row = kClosed;
    Cycle can_activate = 0, can_access = 0, can_precharge = 0;
  };
  struct Answer {
    ClientAnswer answer;
    Cycle due;
  };
  struct Channel {
    std::vector<Waiting> queue;  // oldest first
    std::vector<Bank> banks;
    std::vector<Answer> answers;  // a ring, in the order of the bus
    std::size_t first_answer = 0, answer_count = 0;
    Cycle bus_free = 0;
    Cycle next_refresh = kNever;
  };

  std::size_t channel_of(std::uint64_t address) const { return (address >> line_shift_) & (channels_.size() - 1); }
  Cycle earliest_access(const Channel& channel, const Waiting& waiting, Cycle now) const;
  std::size_t choose(const Channel& channel, Cycle now) const;
  void serve(Channel& channel, std::size_t chosen, Cycle now);
  void refresh_until(Channel& channel, Cycle now);
  Cycle decision_time(const Channel& channel) const;
  void find_next_answer();
  void find_next_decision();

  MemoryConfig config_;
  int line_shift_;
  std::size_t queue_depth_;
  std::uint64_t lines_per_row_;
  Cycle lookahead_;
  std::vector<Channel> channels_;
  std::size_t answering_ = 0;
  std::size_t waiting_ = 0, unanswered_ = 0;
  Cycle next_answer_ = kNever, next_decision_ = kNever;  ///< earliest over the channels
  Counters counters_;
};

}  // namespace ctu::pipeline
