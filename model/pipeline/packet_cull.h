// packet_cull: the rays of a packet look for the places where they must go on alone, once for all of them; the rays
// then begin there and not at the root. Left out when rays do not travel in packets.
//
//   in   rays          contexts whose registers are set up, in the order of the feed
//   in   nodes         nodes of packets whose bytes have come
//   in   released      packets whose rays have all begun
//   out  to_scheduler  the node that a packet is asked about next, under the number of its first ray's context
//   out  starts        rays that go on alone, with their packet; one a cycle, packet after packet
//   A ray joins its packet in the cycle in which it is taken: bounds of origin, reciprocal, tmin and tmax are widened.
//   The first ray of a packet takes free registers, up to packet_cull.packets packets at once. When the last one has
//   joined, the packet's search (model/reference/entry_search.h) asks for the root of
//   its tree; one node of each packet is under
//   way at a time. A node keeps the test's entrance for packet_cull.interval cycles; packet_cull.latency cycles later
//   (4 subtract, 4 multiply, 3 compare, 1 search) the search has its answer, and in the cycle behind that the next node
//   is asked for or the first ray begins. Packets wait for either in the order in which they came to it. Where the
//   image's boxes are of reduced precision, box_decode.latency in front of it, in the same pipeline.
//   stalls: output_full, no_packet
//
// Arithmetic: cull::packet::PacketSlabs. A packet waits for nothing but its own rays, which come as long as there are
// as many contexts as rays in a packet, so it cannot stand still for ever.
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/packet_cull.sv.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/cull/packet/packet_slabs.h"
#include "model/pipeline/context.h"
#include "model/pipeline/event_log.h"
#include "model/pipeline/link.h"
#include "model/pipeline/packets.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

/// Numbers of packets, first come first served.
class PacketQueue {
 public:
  explicit PacketQueue(int packets) : ring_(static_cast<std::size_t>(packets)) {}
  bool empty() const { return count_ == 0; }
  std::uint8_t front() const { return ring_[head_]; }
  void push(std::uint8_t packet) { ring_[(head_ + count_++) % ring_.size()] = packet; }
  void pop() {
    head_ = (head_ + 1) % ring_.size();
    --count_;
  }

 private:
  std::vector<std::uint8_t> ring_;
  std::size_t head_ = 0, count_ = 0;
};

template <class Source, class Wiring>
class PacketCull {
 public:
  static constexpr const char* kName = "packet_cull";
  typename Wiring::template In<JoinToken> rays;
  typename Wiring::template In<RefToken> nodes;
  typename Wiring::template In<PacketToken> released;
  typename Wiring::template Out<RefToken> to_scheduler;
  typename Wiring::template Out<StartToken> starts;

  struct Counters {
    std::uint64_t packets = 0, rays = 0;
    std::uint64_t visits = 0;           ///< of nodes, by packets
    std::uint64_t dropped = 0;          ///< children that all rays of a packet miss
    std::uint64_t entries = 0;          ///< of all packets
    std::uint64_t missing_packets = 0;  ///< without any entry
    std::uint64_t spared = 0;           ///< box tests of single rays, by the recording
    int most_under_way = 0;
  };

  PacketCull(const UnitConfig& config, const UnitImage& image, Contexts& contexts, Packets& packets, Source& source,
             EventLog& log)
      : contexts_(contexts),
        packets_(packets),
        source_(source),
        log_(log),
        image_(image),
        interval_(static_cast<Cycle>(config.packet_cull.interval)),
        pipe_(config.packet_cull.latency + (image.decodes_boxes() ? config.box_decode.latency : 0)),
        free_(packets.count()),
        asking_(packets.count()),
        starting_(packets.count()),
        packet_of_(static_cast<std::size_t>(contexts.count())) {
    for (int packet = 0; packet < packets.count(); ++packet) free_.push(static_cast<std::uint8_t>(packet));
  }

  bool step(Cycle now) {
    bool blocked = false;
    bool moved = ask(now, blocked);
    moved |= start_ray(now, blocked);
    moved |= answer(now);
    moved |= take_node(now);
    bool waits = false;
    moved |= take_ray(now, waits);
    moved |= take_back(now);
    account.set(moved || !pipe_.empty() ? Activity::Busy
                : blocked               ? Activity::OutputFull
                : waits                 ? Activity::NoPacket
                                        : Activity::Idle);
    return moved;
  }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }

  const Counters& counters() const { return counters_; }

  Account account{kName, {Activity::OutputFull, Activity::NoPacket}};

 private:
  static constexpr int kNone = -1;

  /// The oldest packet that waits for a node asks for it.
  bool ask(Cycle now, bool& blocked) {
    if (asking_.empty()) return false;
    if (!to_scheduler.can_push(now)) {
      blocked = true;
      return false;
    }
    const Packet& packet = packets_[asking_.front()];
    to_scheduler.push(now, {packet.search.node(), packet.leader(), true});
    asking_.pop();
    return true;
  }

  /// The next ray of the oldest packet that has found its entries goes on alone.
  bool start_ray(Cycle now, bool& blocked) {
    if (starting_.empty()) return false;
    if (!starts.can_push(now)) {
      blocked = true;
      return false;
    }
    const std::uint8_t number = starting_.front();
    const Packet& packet = packets_[number];
    const bool last = started_ + 1 == packet.members.size();
    starts.push(now, {packet.members[started_], number, last});
    started_ = last ? 0 : started_ + 1;
    if (last) starting_.pop();
    return true;
  }

  /// What the test has found goes into the search.
  bool answer(Cycle now) {
    if (!pipe_.exit_ready(now)) return false;
    const std::uint8_t number = pipe_.leave(now);
    Packet& packet = packets_[number];
    const std::uint32_t node = packet.search.node();
    const reference::Children children = image_.children(node);
    const cull::packet::PacketTimes times = source_.packet_test(number, node);
    const unsigned there = reference::lanes_of(children);
    const bool stays = packet.search.answer(children, times.hit, times.sure, times.t0);
    log_.add({now,
              contexts_[packet.leader()].ray,
              packet.visits++,
              false,
              {node, 0, static_cast<std::uint8_t>(there | unsigned{times.hit} << 4),
               static_cast<std::uint16_t>(kOfPacket | unsigned{times.sure} << 4 | unsigned{stays})}});
    ++counters_.visits;
    counters_.dropped += static_cast<unsigned>(std::popcount(there & ~unsigned{times.hit}));
    if (packet.search.done())
      enter(number);
    else
      asking_.push(number);
    return true;
  }

  void enter(std::uint8_t number) {
    Packet& packet = packets_[number];
    packet.entries = source_.packet_entries(number, packet.search.entries());
    counters_.entries += static_cast<unsigned>(packet.entries.count());
    counters_.missing_packets += packet.entries.count() == 0;
    starting_.push(number);
  }

  bool take_node(Cycle now) {
    if (!nodes.can_pop(now) || !pipe_.can_enter(now)) return false;
    const Slot leader = nodes.front().slot;
    nodes.pop(now);
    contexts_.move(leader, now, Place::PacketCull);
    pipe_.enter(now, packet_of_[leader], interval_);
    return true;
  }

  bool take_ray(Cycle now, bool& waits) {
    if (!rays.can_pop(now)) return false;
    if (filling_ == kNone && rays.front().joins && free_.empty()) {
      waits = true;
      return false;
    }
    const JoinToken token = rays.front();
    rays.pop(now);
    if (token.joins) join(now, token.slot);
    if (token.closes && filling_ != kNone) close();
    return true;
  }

  void join(Cycle now, Slot slot) {
    contexts_.move(slot, now, Place::PacketCull);
    if (filling_ == kNone) open(slot);
    packets_[filling_].members.push_back(slot);
    source_.join_packet(filling_, slot);
    const Context& context = contexts_[slot];
    const std::vector<std::uint16_t>& spared = context.block->steps.spared;
    if (context.index < spared.size()) counters_.spared += spared[context.index];
    ++counters_.rays;
  }

  void open(Slot leader) {
    filling_ = free_.front();
    free_.pop();
    packet_of_[leader] = static_cast<std::uint8_t>(filling_);
    packets_[filling_].members.clear();
    packets_[filling_].visits = 0;
    source_.open_packet(filling_, leader);
    if (++under_way_ > counters_.most_under_way) counters_.most_under_way = under_way_;
  }

  void close() {
    packets_[filling_].search.begin(image_.packet_entries(), source_.packet_begins(filling_),
                                    contexts_[packets_[filling_].leader()].root);
    asking_.push(static_cast<std::uint8_t>(filling_));
    ++counters_.packets;
    filling_ = kNone;
  }

  bool take_back(Cycle now) {
    if (!released.can_pop(now)) return false;
    free_.push(released.front().packet);
    released.pop(now);
    --under_way_;
    return true;
  }

  /// Marks a packet's visits among the events.
  static constexpr unsigned kOfPacket = 0x8000;

  Contexts& contexts_;
  Packets& packets_;
  Source& source_;
  EventLog& log_;
  const UnitImage& image_;
  Cycle interval_;
  Pipe<std::uint8_t> pipe_;
  PacketQueue free_, asking_, starting_;
  std::vector<std::uint8_t> packet_of_;  ///< by the leader's context
  std::size_t started_ = 0;              ///< rays of the oldest packet in starting_
  int filling_ = kNone, under_way_ = 0;
  Counters counters_;
};

}  // namespace ctu::pipeline
