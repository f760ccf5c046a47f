// sphere_test: the spheres among a leaf's primitives, which triangle_test hands on untested (model/intersect/
// sphere_test.h); outcomes of triangles pass by.
//
//   in   tested   outcomes of triangle_test, in order
//   out  outcome  the same, those of spheres with their own
//   latency sphere_test.latency, an outcome a cycle
//   stalls: output_full
//
// There only where the image has spheres. A sphere is tested against the best hit of the cycle in which it is taken.
// Stated for both twins in docs/unit.md. Twin in gates: rtl/sphere_test.sv.
#pragma once

#include <cstdint>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class SphereTest {
 public:
  static constexpr const char* kName = "sphere_test";
  typename Wiring::template In<typename Source::Test> tested;
  typename Wiring::template Out<typename Source::Test> outcome;

  SphereTest(const UnitConfig& config, Contexts& contexts, Source& source)
      : contexts_(contexts), source_(source), pipe_(config.sphere_test.latency) {}

  bool step(Cycle now) {
    return step_pipelined(now, tested, outcome, pipe_, account, [&](const typename Source::Test& test) {
      if (test.last) contexts_.move(test.slot, now, Place::SphereTest);
      spheres_ += test.is_sphere();
      return Entering<typename Source::Test>{source_.sphere_test(test)};
    });
  }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  std::uint64_t spheres() const { return spheres_; }

  Account account{kName, {Activity::OutputFull}};

 private:
  Contexts& contexts_;
  Source& source_;
  Pipe<typename Source::Test> pipe_;
  std::uint64_t spheres_ = 0;
};

}  // namespace ctu::pipeline
