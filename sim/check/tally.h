// What a campaign counts, for each generator and in all.
#pragma once

#include <cstdint>

#include "tests/oracle/ray_oracle.h"

namespace ctu::sim::check {

struct Tally {
  std::uint64_t scenes = 0;
  std::uint64_t rays = 0;  ///< the cases

  // Pairs of a ray and a primitive that it meets exactly: kept + lost + declined + misplaced.
  std::uint64_t exact_hits = 0;
  std::uint64_t kept = 0;
  std::uint64_t lost = 0;       ///< a test in front rejects it, or the answer does not account for it
  std::uint64_t declined = 0;   ///< by the rounded triangle test alone, behind everything else
  std::uint64_t misplaced = 0;  ///< accepted before an answer that the exact ray comes to first

  std::uint64_t near_misses = 0;  ///< pairs that the triangle test accepts and the exact ray misses
  std::uint64_t ties = 0;         ///< rays whose nearest exact hits are several at one t
  std::uint64_t invented = 0;     ///< answers that no triangle gives
  std::uint64_t differences = 0;  ///< answers or visits of the unit that are not the reference's
  std::uint64_t failed_rays = 0;  ///< with a loss, an invention or a difference

  // Lanes on the way to exact hits that the box test passes, and of these
  std::uint64_t lanes = 0;
  std::uint64_t uncertain_lanes = 0;  ///< passed unasked because rounding left two candidate cells

  // Cells of sampled lanes; see cell_sample.h.
  std::uint64_t sampled_lanes = 0;
  std::uint64_t cells_marked = 0, cells_exact = 0;
  std::uint64_t cells_over = 0;  ///< marked and not touched: culling given away by rounding and by tables
  std::uint64_t cells_lost = 0;  ///< touched and not marked

  oracle::OracleCounts oracle;

  bool failed() const { return lost + invented + differences + cells_lost != 0; }
  Tally& operator+=(const Tally& other);
};

}  // namespace ctu::sim::check
