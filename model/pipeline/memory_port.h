// memory_port: the unit's one port to memory. Node fetch, leaf fetch, the stack's spills and table fetch take turns at
// it.
//
//   in   requests[client], out answers[client]
//   One request a cycle goes to memory, chosen round-robin among the clients whose request memory can take; one answer
//   a cycle comes back, in the order in which memory has them ready. An answer ready in cycle t is pushed in t. stalls:
//   output_full (an answer is ready and its client takes none), memory (requests wait for memory)
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/memory_port.sv.
#pragma once

#include "model/pipeline/accounting.h"
#include "model/pipeline/link.h"
#include "model/pipeline/memory_banked.h"
#include "model/pipeline/memory_client.h"
#include "model/pipeline/memory_ideal.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Wiring>
class MemoryPort {
 public:
  static constexpr const char* kName = "memory_port";
  typename Wiring::template In<MemoryRequest> requests[kClients];
  typename Wiring::template Out<MemoryResponse> answers[kClients];

  /// `last`: the last client that is there. Of those before it, one that is left out never asks and so takes no turn.
  MemoryPort(const UnitConfig& config, Client last)
      : clients_(static_cast<int>(last) + 1),
        banked_(config.memory.model == MemoryModel::Banked),
        ideal_memory_(config.memory),
        banked_memory_(config.memory, most_reads(config)) {}

  bool step(Cycle now) { return banked_ ? step_over(banked_memory_, now) : step_over(ideal_memory_, now); }
  Cycle next_event(Cycle now) const { return banked_ ? banked_memory_.next_event(now) : ideal_memory_.next_event(now); }

  std::uint64_t requests_of(Client client) const { return granted_[static_cast<int>(client)]; }
  std::uint64_t writes() const { return writes_; }
  const BankedMemory* banked() const { return banked_ ? &banked_memory_ : nullptr; }

  Account account{kName, {Activity::OutputFull, Activity::Memory}};

 private:
  /// Each miss register has one under way, and each context one refill of its stack.
  static std::size_t most_reads(const UnitConfig& config) {
    std::size_t reads = 0;
    for (const int count :
         {config.node_cache.mshrs, config.leaf_cache.mshrs, config.table_cache.mshrs, config.unit.contexts})
      reads += static_cast<std::size_t>(count);
    return reads;
  }

  template <class Memory>
  bool step_over(Memory& memory, Cycle now) {
    if (!asked(now) && !memory.due(now)) {  // most cycles, so settled at once
      account.set(memory.empty() ? Activity::Idle : Activity::Busy);
      return false;
    }
    return serve(memory, now);
  }
  template <class Memory>
  [[gnu::noinline]] bool serve(Memory& memory, Cycle now) {
    bool moved = false, blocked = false;
    if (memory.answer_ready(now)) {
      const ClientAnswer& answer = memory.answer();
      auto& out = answers[static_cast<int>(answer.client)];
      if (out.can_push(now)) {
        out.push(now, {answer.id});
        memory.take_answer();
        moved = true;
      } else {
        blocked = true;
      }
    }
    const Grant grant = arbitrate(memory, now);
    moved |= memory.work(now);
    moved |= grant == Grant::Given;
    account.set(blocked                    ? Activity::OutputFull
                : grant == Grant::Refused  ? Activity::Memory
                : moved || !memory.empty() ? Activity::Busy
                                           : Activity::Idle);
    return moved;
  }

  bool asked(Cycle now) const {
    bool any = false;
    for (const auto& in : requests) any |= in.can_pop(now);
    return any;
  }

  enum class Grant : std::uint8_t { None, Given, Refused };

  template <class Memory>
  Grant arbitrate(Memory& memory, Cycle now) {
    Grant outcome = Grant::None;
    for (int i = 0, client = turn_; i < clients_; ++i, client = client + 1 == clients_ ? 0 : client + 1) {
      auto& in = requests[client];
      if (!in.can_pop(now)) continue;
      const ClientRequest request{static_cast<Client>(client), in.front()};
      if (!takes(memory, now, request.request.address)) {
        outcome = Grant::Refused;
        continue;
      }
      in.pop(now);
      memory.accept(now, request);
      ++granted_[client];
      writes_ += request.request.write;
      turn_ = client + 1 == clients_ ? 0 : client + 1;
      return Grant::Given;
    }
    return outcome;
  }
  static bool takes(const IdealMemory& memory, Cycle now, std::uint64_t) { return memory.can_accept(now); }
  static bool takes(const BankedMemory& memory, Cycle, std::uint64_t address) { return memory.can_accept(address); }

  int clients_, turn_ = 0;
  bool banked_;
  IdealMemory ideal_memory_;
  BankedMemory banked_memory_;
  std::uint64_t granted_[kClients] = {};
  std::uint64_t writes_ = 0;
};

}  // namespace ctu::pipeline
