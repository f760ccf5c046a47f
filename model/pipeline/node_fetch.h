// node_fetch: brings the bytes of a node, [node_address, + stride), through node_cache. Ports and timing: line_fetch.h.
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/node_fetch.sv.
#pragma once

#include "model/pipeline/line_fetch.h"
#include "model/pipeline/span_lines.h"

namespace ctu::pipeline {

template <class Wiring>
class NodeFetch : public LineFetch<SpanLines<RefToken>, Wiring> {
 public:
  static constexpr const char* kName = "node_fetch";
  NodeFetch(const UnitConfig& config, const UnitImage& image, Contexts& contexts)
      : LineFetch<SpanLines<RefToken>, Wiring>(kName, config.node_cache, config.memory.line_bytes,
                                               {image, config.memory.line_bytes}, contexts, Place::NodeFetchHit,
                                               Place::NodeFetchMiss) {}
};

}  // namespace ctu::pipeline
