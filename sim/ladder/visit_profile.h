// What the closed forms of the estimate are computed from: counts of what the rays of a trace ask of each stage, and of
// how long ago the lines that they ask for were used. None of it is a time; one profile serves all latencies,
// intervals, cache sizes, miss registers and memories.
//
// The order in which the unit's contexts take turns decides what a cache holds. Here every context makes one visit a
// round, which is what rays do whose visits take equally long.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/pipeline/unit_config.h"
#include "model/reference/ray_block.h"
#include "sim/ladder/line_stack.h"

namespace ctu::ladder {

/// Sizes of a cache for which it is kept how recently a line had come: capacity(4 c) lines, 8, 32, ... 131072.
inline constexpr int kSizeClasses = 8;
/// Visits since a line came, two buckets to an octave: 1, 2, 3, 4, 6, 8, 12, ... 6144.
inline constexpr int kAgeBuckets = 26;
inline constexpr int kRowBuckets = 12;
inline constexpr int kMostPrimitives = 16;
inline constexpr int kMostLines = 48;  ///< of one visit

/// The lines that one fetch stage was asked for.
struct LineProfile {
  std::uint64_t visits = 0, lookups = 0, bytes = 0;
  std::array<std::uint64_t, kGroups> lines{};            ///< lookups, by the group of the line
  std::array<std::uint64_t, kGroups> by_farthest{};      ///< visits, by the highest group among their lines
  std::array<std::uint64_t, kMostLines + 1> by_lines{};  ///< visits, by their lines
  /// Visits all of whose lines such a cache held, one of which had come so many visits before.
  std::array<std::array<std::uint64_t, kAgeBuckets>, kSizeClasses> recent{};
  /// Lines that such a cache did not hold, by how many of them ago one of the same memory row was: 1, 2 to 3, 4 to 7,
  /// ...
  std::array<std::array<std::uint64_t, kRowBuckets>, kSizeClasses> row_distance{};
};

/// Of some consecutive rays.
struct Phase {
  std::uint64_t rays = 0, entered = 0;  ///< entered: they visit anything
  std::uint64_t nodes = 0, leaves = 0, box_hits = 0, culled = 0, uncertain = 0, dropped = 0;
  std::uint64_t triangles = 0, boxed_out = 0;
  std::uint64_t lanes_unasked = 0;
  /// Nodes by lanes asked and by the turns that their reads take at the banks of the tables.
  std::array<std::array<std::uint64_t, 13>, 5> asked_turns{};
  std::array<std::uint64_t, 5> survivors{};                ///< nodes, by survivors
  std::array<std::uint64_t, kMostPrimitives + 1> tests{};  ///< leaves, by primitives tested
  std::uint64_t leaf_primitives = 0;                       ///< in the leaves visited
  std::uint64_t pushes = 0, pops = 0, spills = 0, refills = 0, deepest = 0;
  std::uint64_t longest_visits = 0;  ///< of one ray
  LineProfile node, leaf, table;
};
static_assert(std::is_trivially_copyable_v<Phase>);

/// One on-chip table and its reads.
struct TableUse {
  std::string name;
  std::uint64_t rows = 0, row_bits = 0;
  std::uint64_t reads = 0, shared_reads = 0, rows_used = 0;
};

struct VisitProfile {
  std::uint64_t rays_in_all = 0;  ///< that the phases stand for; they may be a sample
  std::vector<Phase> phases;
  std::vector<TableUse> tables;  ///< in the order of OnChipTables::tables()

  std::uint64_t rays() const;
};

/// Of a profile, at most; none has fewer rays than kPhaseRays but the last one.
inline constexpr std::uint64_t kPhases = 16, kPhaseRays = 1024;

/// What of a configuration a profile depends on, as text.
std::string profile_key(const pipeline::UnitConfig& config);

/// Counts the rays of the feed, whose blocks have the steps of the tester's design; `rays_in_all` is left to the
/// caller. Throws Error when the rays travel in packets.
VisitProfile count_visits(const accel::Image& image, const cull::MaskTester& tester, const pipeline::UnitConfig& config,
                          reference::RayFeed& feed);

/// The sum.
Phase& operator+=(Phase& sum, const Phase& other);

}  // namespace ctu::ladder
