// node_fetch: brings the bytes of a node, [node_address, + stride), through node_cache. Ports and timing: line_fetch.h.
#pragma once

#include "model/pipeline/line_fetch.h"

namespace ctu::pipeline {

template <class Wiring>
class NodeFetch : public LineFetch<RefToken, Wiring> {
 public:
  static constexpr const char* kName = "node_fetch";
  NodeFetch(const UnitConfig& config, const UnitImage& image, Contexts& contexts)
      : LineFetch<RefToken, Wiring>(kName, config.node_cache, config.memory.line_bytes, image, contexts,
                                    Place::NodeFetchHit, Place::NodeFetchMiss) {}
};

}  // namespace ctu::pipeline
