// triangle_test: the triangles of a leaf, one after the other, into one watertight triangle tester
// (model/intersect/triangle_test.h). Spheres go through it untested, primitives that primitive_cull has thrown away not
// at all.
//
//   in   leaf    a context and the leaf whose bytes have come
//   out  tested  one outcome for each primitive
//   latency triangle_test.latency, a triangle each triangle_test.interval cycles; the next leaf follows without a gap
//   stalls: output_full, interval (a triangle waits for the interval)
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/triangle_test.sv.
#pragma once

#include <bit>
#include <cstdint>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class TriangleTest {
 public:
  static constexpr const char* kName = "triangle_test";
  typename Wiring::template In<LeafToken> leaf;
  typename Wiring::template Out<typename Source::Test> tested;

  TriangleTest(const UnitConfig& config, Contexts& contexts, Source& source)
      : contexts_(contexts),
        source_(source),
        interval_(static_cast<Cycle>(config.triangle_test.interval)),
        pipe_(config.triangle_test.latency) {}

  bool step(Cycle now) {
    bool moved = false;
    if (pipe_.exit_ready(now)) {
      if (!tested.can_push(now)) {
        pipe_.freeze(now);
        account.set(Activity::OutputFull);
        return false;
      }
      tested.push(now, pipe_.leave(now));
      moved = true;
    }
    const bool waits = rest_ != 0 || leaf.can_pop(now);
    const bool enters = waits && pipe_.can_enter(now);
    if (enters) {
      if (rest_ == 0) take_leaf(now);
      test_next(now);
      moved = true;
    }
    account.set(waits && !enters ? Activity::Interval : moved || !pipe_.empty() ? Activity::Busy : Activity::Idle);
    return moved;
  }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  std::uint64_t leaves() const { return leaves_; }
  std::uint64_t triangles() const { return triangles_; }

  Account account{kName, {Activity::OutputFull, Activity::Interval}};

 private:
  void take_leaf(Cycle now) {
    current_ = leaf.front();
    leaf.pop(now);
    contexts_.move(current_.slot, now, Place::TriangleTest);
    rest_ = current_.met & ((1u << accel::leaf_count(current_.ref)) - 1);
    ++leaves_;
  }
  void test_next(Cycle now) {
    const int index = std::countr_zero(rest_);
    rest_ &= rest_ - 1;
    pipe_.enter(now, source_.triangle_test(current_.slot, current_.ref, index, rest_ == 0), interval_);
    ++triangles_;
  }

  Contexts& contexts_;
  Source& source_;
  Cycle interval_;
  Pipe<typename Source::Test> pipe_;
  LeafToken current_;
  unsigned rest_ = 0;  ///< bit i: primitive i of the leaf is still to be tested
  std::uint64_t leaves_ = 0, triangles_ = 0;
};

}  // namespace ctu::pipeline
