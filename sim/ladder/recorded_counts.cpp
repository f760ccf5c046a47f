#include "sim/ladder/recorded_counts.h"

#include <cmath>

namespace ctu::ladder {

const reference::Counts* recorded_counts(const TraceWork& work) {
  const cull::Design design = cull::event_class(work.tester.design());
  const traces::DesignCounts* counts = work.reader.manifest().find(design);
  const bool whole = work.range.first == 0 && work.range.last >= work.reader.rays();
  const bool same = counts != nullptr && traces::holds_steps(work.reader, design, work.tester.options());
  return whole && same ? &counts->counts : nullptr;
}

reference::Counts scaled_counts(const reference::Counts& counts, double factor, std::uint64_t rays) {
  const auto scaled = [&](std::uint64_t count) {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(count) * factor));
  };
  return {.rays = rays,
          .node_visits = scaled(counts.node_visits),
          .triangle_tests = scaled(counts.triangle_tests),
          .boxed_out = scaled(counts.boxed_out),
          .leaf_visits = scaled(counts.leaf_visits),
          .box_hits = scaled(counts.box_hits),
          .culled = scaled(counts.culled),
          .uncertain = scaled(counts.uncertain),
          .dropped = scaled(counts.dropped)};
}

bool is_extreme(const std::string& name) {
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  return has("most_") || has("deepest") || has(".rows") || has("bits");
}

}  // namespace ctu::ladder
