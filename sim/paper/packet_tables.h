// The tables of `ctusim paper packets`, as Markdown.
#pragma once

#include <string>
#include <vector>

#include "sim/paper/packet_measure.h"

namespace ctu::sim::paper {

/// One scene with one kind of rays.
struct PacketRow {
  std::string scene, rays;
  PacketResult result;
};

/// The packets' sizes and ways to form them that are set side by side.
inline constexpr std::array<int, 5> kSweepSizes = {4, 8, 16, 32, 64};
inline constexpr std::array<reference::Forming, 3> kSweepForming = {
    reference::Forming::Order, reference::Forming::Direction, reference::Forming::Origin};

/// One kind of rays: what AxisInterval leaves of the tests, by forming and size, in percent and summed over scenes.
struct PacketSweep {
  std::string rays;
  std::uint64_t scenes = 0;
  struct Cell {
    double ray_tests = 0, all_tests = 0;  ///< single rays'; with the packets' own
  };
  std::array<std::array<Cell, kSweepSizes.size()>, kSweepForming.size()> cells{};
};

/// Tests of single rays, with one box or one triangle, as a share of those that the rays would make alone; and the
/// packets' own, of which each counts one too.
struct PacketShares {
  double ray_tests = 0, packet_tests = 0;
};
PacketShares shares_of(const reference::PacketCounts& counts);

std::string packet_report(const std::vector<PacketRow>& rows, const std::vector<PacketSweep>& sweeps);

}  // namespace ctu::sim::paper
