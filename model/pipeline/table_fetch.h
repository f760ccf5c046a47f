// table_fetch: brings the rows of tables that lie in memory through table_cache, for the lanes that are asked. Left out
// when tables are resident. Ports and timing: line_fetch.h. A node's distinct lines are looked up in the order of its
// lanes; Dedup's are looked up in two rounds, the lines of the ids first; a node without any
// leaves in the cycle behind the one in which it is taken. Nodes may leave in another order than they came.
//
// Stated for both twins in docs/unit.md.
#pragma once

#include "model/pipeline/line_fetch.h"
#include "model/pipeline/table_lines.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class TableFetch : public LineFetch<TableLines<Source>, Wiring> {
 public:
  static constexpr const char* kName = "table_fetch";
  TableFetch(const UnitConfig& config, const cull::OnChipTables& tables, const UnitImage& image, Contexts& contexts,
             Source& source)
      : LineFetch<TableLines<Source>, Wiring>(kName, config.table_cache, config.memory.line_bytes,
                                              {config, tables, image, contexts, source}, contexts, Place::TableFetchHit,
                                              Place::TableFetchMiss) {}
};

}  // namespace ctu::pipeline
