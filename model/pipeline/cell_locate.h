// cell_locate: for each lane hit, where the ray's segment begins and ends in the box's grid (designs with tables), or
// which cells it touches (comparators). A lane whose object mask is full passes unasked: whatever the ray touches is
// occupied, so it takes no turn here, no table row and no mask test. Left out when there is no mask test.
//
//   in   tested   the lanes hit
//   out  located  the same, with the lanes asked; their keys, or touched cells, stay with the context
//   A node with a lanes asked keeps the entrance for ceil(a / units) cycles, at least one. Latency cell_locate.latency
//   (bisection on [t0, t1]: adders and comparisons only) or comparators.latency, counted from the last of these cycles.
//   stalls: output_full
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/cell_locate.sv.
#pragma once

#include <algorithm>
#include <bit>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class CellLocate {
 public:
  static constexpr const char* kName = "cell_locate";
  static constexpr Place kPlace = Place::CellLocate;
  typename Wiring::template In<NodeToken> tested;
  typename Wiring::template Out<NodeToken> located;

  CellLocate(const UnitConfig& config, Contexts& contexts, Source& source)
      : contexts_(contexts), source_(source), pipe_(latency_of(config)) {
    for (int lanes = 0; lanes <= intersect::kLanes; ++lanes)
      cycles_of_[lanes] = std::max(1, (lanes + units(config) - 1) / units(config));
  }

  bool step(Cycle now) {
    return step_pipelined(now, tested, located, pipe_, account, [&](const NodeToken& token) {
      contexts_.move(token.slot, now, kPlace);
      return take(token);
    });
  }
  Entering<NodeToken> take(const NodeToken& token) {
    const std::uint8_t asked = source_.locate(token.slot, token.hits);
    const int lanes = std::popcount(asked);
    const int cycles = cycles_of_[lanes];
    lanes_ += static_cast<unsigned>(lanes);
    lanes_unasked_ += static_cast<unsigned>(std::popcount(token.hits) - lanes);
    occupied_ += static_cast<unsigned>(cycles);
    return {{token.slot, token.hits, token.hits, 0, asked}, static_cast<Cycle>(cycles)};
  }
  Cycle latency() const { return pipe_.latency(); }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  std::uint64_t lanes() const { return lanes_; }
  /// Lanes hit that pass without a question.
  std::uint64_t lanes_unasked() const { return lanes_unasked_; }
  /// Cycles in which the entrance was taken.
  std::uint64_t occupied() const { return occupied_; }

  Account account{kName, {Activity::OutputFull}};

 private:
  static bool compares(const UnitConfig& config) { return config.mask_test.design == cull::Design::Comparators; }
  static int units(const UnitConfig& config) {
    return compares(config) ? config.comparators.units : config.cell_locate.units;
  }
  static int latency_of(const UnitConfig& config) {
    return compares(config) ? config.comparators.latency : config.cell_locate.latency;
  }

  Contexts& contexts_;
  Source& source_;
  int cycles_of_[intersect::kLanes + 1];  ///< at the entrance, by the number of lanes asked
  Pipe<NodeToken> pipe_;
  std::uint64_t lanes_ = 0, lanes_unasked_ = 0, occupied_ = 0;
};

}  // namespace ctu::pipeline
