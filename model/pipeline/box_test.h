// box_test: the ray against the boxes of a node's four lanes, with outward rounding (model/intersect/slab_test.h).
//
//   in   node    a context and the node whose bytes have come
//   out  tested  the lanes hit; times and boxes stay with the context
//   latency box_test.latency (4 subtract, 4 multiply, 3 compare: 11), one node a cycle; where the image's boxes are of
//           reduced precision, box_decode.latency (1 convert, 4 add: 5) in front of it, in the same rigid pipeline
//   stalls: output_full
//
// Boxes of reduced precision become binary32 planes by accel::decode_plane; the image (unit_image.h) has done so.
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/box_test.sv, rtl/box_decode.sv.
#pragma once

#include <bit>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class BoxTest {
 public:
  static constexpr const char* kName = "box_test";
  static constexpr Place kPlace = Place::BoxTest;
  typename Wiring::template In<RefToken> node;
  typename Wiring::template Out<NodeToken> tested;

  BoxTest(const UnitConfig& config, const UnitImage& image, Contexts& contexts, Source& source)
      : contexts_(contexts),
        source_(source),
        pipe_(config.box_test.latency + (image.decodes_boxes() ? config.box_decode.latency : 0)) {}

  bool step(Cycle now) {
    return step_pipelined(now, node, tested, pipe_, account, [&](const RefToken& token) {
      contexts_.move(token.slot, now, kPlace);
      return take(token);
    });
  }
  Entering<NodeToken> take(const RefToken& token) {
    const std::uint8_t hits = source_.box_test(token.slot, token.ref);
    ++nodes_;
    box_hits_ += static_cast<unsigned>(std::popcount(hits));
    return {{token.slot, hits, hits, 0, 0}};
  }
  Cycle latency() const { return pipe_.latency(); }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  std::uint64_t nodes() const { return nodes_; }
  std::uint64_t box_hits() const { return box_hits_; }

  Account account{kName, {Activity::OutputFull}};

 private:
  Contexts& contexts_;
  Source& source_;
  Pipe<NodeToken> pipe_;
  std::uint64_t nodes_ = 0, box_hits_ = 0;
};

}  // namespace ctu::pipeline
