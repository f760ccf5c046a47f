// Which rows of the design's tables the lanes of a node read.
#pragma once

#include <string>

#include "model/base/error.h"
#include "model/cull/on_chip_tables.h"
#include "model/pipeline/context.h"
#include "model/pipeline/outcome.h"

namespace ctu::pipeline {

/// A ray whose key has no row: it begins inside a box, where `reachable` keeps only rows for rays from outside.
[[noreturn, gnu::cold, gnu::noinline]] inline void throw_row_left_out(const Context& context) {
  throw Error("ray " + std::to_string(context.ray) + ", visit " + std::to_string(context.visits),
              "begins inside a box, and mask_test.rows = reachable leaves out the table rows of such rays",
              "choose mask_test.rows = folded");
}

/// Calls `read(table row, mask index of the lane)` for every read that the lanes make. Uncertain lanes make none.
/// Throws Error when a row was left out.
template <class Read>
void for_each_read(const cull::OnChipTables& tables, const LaneKeys& lanes, const Context& context, Read&& read) {
  for (int i = 0; i < lanes.count; ++i) {
    const cull::CellKey key{lanes.key[i]};
    if (key.uncertain()) continue;
    cull::TableRead reads[cull::kMaxReadsOfLane];
    const int count = tables.reads(key, lanes.mask_index[i], reads);
    if (count < 0) [[unlikely]]
      throw_row_left_out(context);
    for (int r = 0; r < count; ++r) read(reads[r], lanes.mask_index[i]);
  }
}

/// Dedup reads its second memory with the id that the first one gives.
constexpr bool reads_twice(cull::Design design) { return design == cull::Design::Dedup; }
/// Whether this memory is the one read with the id.
constexpr bool is_second_read(cull::Design design, int table) { return reads_twice(design) && table == 1; }

}  // namespace ctu::pipeline
