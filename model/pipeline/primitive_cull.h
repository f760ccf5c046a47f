// primitive_cull: the box of the ray's stay in a leaf against the box of each primitive there
// (model/cull/leaf_culling.h, RayBoxRule::OncePerLeaf); those it misses are not tested.
//
//   in   leaf    a context and the leaf whose bytes have come
//   out  passed  the leaf, with the primitives that are left to test
//   out  missed  contexts whose leaf has none left
//   latency primitive_cull.latency; a leaf keeps the entrance for ceil(primitives / primitive_cull.units) cycles
//   stalls: output_full
//
// There only where the image has primitive boxes. The ray's box ends at the best hit of the cycle in which the leaf is
// taken. Stated for both twins in docs/unit.md. Twin in gates: rtl/primitive_cull.sv.
#pragma once

#include <bit>
#include <cstdint>

#include "model/cull/leaf_culling.h"
#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class PrimitiveCull {
 public:
  static constexpr const char* kName = "primitive_cull";
  typename Wiring::template In<LeafToken> leaf;
  typename Wiring::template Out<LeafToken> passed;
  typename Wiring::template Out<SlotToken> missed;

  struct Counters {
    std::uint64_t boxes = 0;    ///< of primitives, held against one of a ray
    std::uint64_t culled = 0;   ///< ... and not met
    std::uint64_t emptied = 0;  ///< leaves without a primitive left
  };

  PrimitiveCull(const UnitConfig& config, Contexts& contexts, Source& source)
      : contexts_(contexts),
        source_(source),
        units_(config.primitive_cull.units),
        pipe_(config.primitive_cull.latency) {}

  bool step(Cycle now) {
    bool moved = false;
    if (pipe_.exit_ready(now)) {
      if (!push(now)) {
        pipe_.freeze(now);
        account.set(Activity::OutputFull);
        return false;
      }
      moved = true;
    }
    if (leaf.can_pop(now) && pipe_.can_enter(now)) {
      take(now);
      moved = true;
    }
    account.set(moved || !pipe_.empty() ? Activity::Busy : Activity::Idle);
    return moved;
  }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  const Counters& counters() const { return counters_; }

  Account account{kName, {Activity::OutputFull}};

 private:
  /// The leaf in the last register leaves, if its link has room.
  bool push(Cycle now) {
    const LeafToken& token = pipe_.front();
    if (token.met != 0) {
      if (!passed.can_push(now)) return false;
      passed.push(now, pipe_.leave(now));
    } else {
      if (!missed.can_push(now)) return false;
      missed.push(now, {pipe_.leave(now).slot});
    }
    return true;
  }

  void take(Cycle now) {
    LeafToken token = leaf.front();
    leaf.pop(now);
    contexts_.move(token.slot, now, Place::PrimitiveCull);
    const int count = accel::leaf_count(token.ref);
    token.met = source_.primitive_cull(token.slot, token.ref);
    if (count >= static_cast<int>(cull::kLeastCulledPrimitives)) counters_.boxes += static_cast<std::uint64_t>(count);
    counters_.culled += static_cast<std::uint64_t>(count - std::popcount(token.met));
    counters_.emptied += token.met == 0;
    pipe_.enter(now, token, static_cast<Cycle>((count + units_ - 1) / units_));
  }

  Contexts& contexts_;
  Source& source_;
  int units_;
  Pipe<LeafToken> pipe_;
  Counters counters_;
};

}  // namespace ctu::pipeline
