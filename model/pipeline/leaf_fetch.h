// leaf_fetch: brings the bytes of all triangles of a leaf through leaf_cache. Ports and timing: line_fetch.h.
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/leaf_fetch.sv.
#pragma once

#include "model/pipeline/line_fetch.h"
#include "model/pipeline/span_lines.h"

namespace ctu::pipeline {

template <class Wiring>
class LeafFetch : public LineFetch<SpanLines<LeafToken>, Wiring> {
 public:
  static constexpr const char* kName = "leaf_fetch";
  LeafFetch(const UnitConfig& config, const UnitImage& image, Contexts& contexts)
      : LineFetch<SpanLines<LeafToken>, Wiring>(kName, config.leaf_cache, config.memory.line_bytes,
                                                {image, config.memory.line_bytes}, contexts, Place::LeafFetchHit,
                                                Place::LeafFetchMiss) {}
};

}  // namespace ctu::pipeline
