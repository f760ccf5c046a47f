#include "model/pipeline/memory_banked.h"

#include <algorithm>
#include <bit>

namespace ctu::pipeline {

BankedMemory::BankedMemory(const MemoryConfig& config, std::size_t most_reads)
    : config_(config),
      line_shift_(std::countr_zero(static_cast<unsigned>(config.line_bytes))),
      queue_depth_(static_cast<std::size_t>(config.queue_depth)),
      lines_per_row_(static_cast<std::uint64_t>(config.row_bytes / config.line_bytes)),
      lookahead_(static_cast<Cycle>(config.t_rp + config.t_rcd + config.t_cl)),
      channels_(static_cast<std::size_t>(config.channels)) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    Channel& channel = channels_[c];
    channel.queue.reserve(queue_depth_);
    channel.banks.resize(static_cast<std::size_t>(config.banks));
    channel.answers.resize(std::bit_ceil(most_reads));
    // Channels refresh one after the other, not all at once.
    if (config.t_rfc > 0) channel.next_refresh = static_cast<Cycle>(config.t_refi) * (c + 1) / channels_.size();
  }
}

void BankedMemory::accept(Cycle now, const ClientRequest& request) {
  const std::uint64_t line = request.request.address >> line_shift_;
  const std::uint64_t in_channel = line / channels_.size();
  const std::uint64_t block = in_channel / lines_per_row_;
  const auto banks = static_cast<std::uint64_t>(config_.banks);
  const std::uint64_t row = block / banks;
  // Rows of neighbouring addresses fall into different banks, also over strides of whole rows.
  const auto bank = static_cast<std::uint32_t>((block ^ row) & (banks - 1));
  channels_[channel_of(request.request.address)].queue.push_back({request, now, bank, row});
  ++waiting_;
  find_next_decision();
  if (!request.request.write) ++unanswered_;
  ++(request.request.write ? counters_.writes : counters_.reads);
}

Cycle BankedMemory::earliest_access(const Channel& channel, const Waiting& waiting, Cycle now) const {
  const Bank& bank = channel.banks[waiting.bank];
  if (bank.row == waiting.row) return std::max(now, bank.can_access);
  const auto t_rp = static_cast<Cycle>(config_.t_rp), t_rcd = static_cast<Cycle>(config_.t_rcd);
  if (bank.row == Bank::kClosed) return std::max(now, bank.can_activate) + t_rcd;
  return std::max(now, bank.can_precharge) + t_rp + t_rcd;
}

std::size_t BankedMemory::choose(const Channel& channel, Cycle now) const {
  if (now - channel.queue[0].arrived > static_cast<Cycle>(config_.age_cap)) return 0;
  std::size_t best = 0;
  Cycle best_access = kNever;
  for (std::size_t i = 0; i < channel.queue.size(); ++i) {
    const Cycle access = earliest_access(channel, channel.queue[i], now);
    if (access < best_access) {
      best_access = access;
      best = i;
    }
  }
  return best;
}

void BankedMemory::serve(Channel& channel, std::size_t chosen, Cycle now) {
  const Waiting waiting = channel.queue[chosen];
  channel.queue.erase(channel.queue.begin() + static_cast<std::ptrdiff_t>(chosen));
  --waiting_;
  Bank& bank = channel.banks[waiting.bank];
  const bool row_hit = bank.row == waiting.row;
  const Cycle earliest = earliest_access(channel, waiting, now);
  const auto t_cl = static_cast<Cycle>(config_.t_cl), burst = static_cast<Cycle>(config_.burst);
  const Cycle data = std::max(earliest + t_cl, channel.bus_free);
  const Cycle access = data - t_cl;
  if (row_hit) {
    ++counters_.row_hits;
  } else {
    bank.row = waiting.row;
    bank.can_precharge = earliest - static_cast<Cycle>(config_.t_rcd) + static_cast<Cycle>(config_.t_ras);
  }
  bank.can_access = access;
  bank.can_precharge = std::max(bank.can_precharge, access + burst);
  channel.bus_free = data + burst;
  counters_.bus_cycles += burst;
  if (waiting.request.request.write) return;
  const std::size_t place = (channel.first_answer + channel.answer_count++) & (channel.answers.size() - 1);
  channel.answers[place] = {{waiting.request.client, waiting.request.request.id},
                            data + burst + static_cast<Cycle>(config_.front_latency)};
  find_next_answer();
}

void BankedMemory::refresh_until(Channel& channel, Cycle now) {
  while (channel.next_refresh <= now) {
    for (Bank& bank : channel.banks) {
      const Cycle closed =
          bank.row == Bank::kClosed ? channel.next_refresh : std::max(channel.next_refresh, bank.can_precharge);
      bank.row = Bank::kClosed;
      bank.can_activate = closed + static_cast<Cycle>(config_.t_rfc);
    }
    ++counters_.refreshes;
    channel.next_refresh += static_cast<Cycle>(config_.t_refi);
  }
}

Cycle BankedMemory::decision_time(const Channel& channel) const {
  return channel.bus_free > lookahead_ ? channel.bus_free - lookahead_ : 0;
}

bool BankedMemory::work(Cycle now) {
  if (next_decision_ > now) return false;
  for (Channel& channel : channels_) {
    if (channel.queue.empty() || decision_time(channel) > now) continue;
    refresh_until(channel, now);
    serve(channel, choose(channel, now), now);
  }
  find_next_decision();
  return true;
}

void BankedMemory::find_next_decision() {
  next_decision_ = kNever;
  for (const Channel& channel : channels_)
    if (!channel.queue.empty()) next_decision_ = std::min(next_decision_, decision_time(channel));
}

void BankedMemory::find_next_answer() {
  next_answer_ = kNever;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    if (channel.answer_count == 0 || channel.answers[channel.first_answer].due >= next_answer_) continue;
    next_answer_ = channel.answers[channel.first_answer].due;
    answering_ = c;
  }
}

void BankedMemory::take_answer() {
  Channel& channel = channels_[answering_];
  channel.first_answer = (channel.first_answer + 1) & (channel.answers.size() - 1);
  --channel.answer_count;
  --unanswered_;
  find_next_answer();
}

Cycle BankedMemory::next_event(Cycle now) const { return std::max(std::min(next_decision_, next_answer_), now + 1); }

}  // namespace ctu::pipeline
