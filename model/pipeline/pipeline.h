// The whole unit: every stage, every link, and one cycle of all of them.
//
//   ray_queue -> [packet_cull ->] scheduler -> node_fetch -> box_test [, packet_cull]
//                  |  ^         -> [cell_locate -> [table_fetch ->] mask_test ->] child_sort -> traversal_stack
//                  |  +--------------------------------------------------------------------------+  ^  +-> result_queue
//                  +-> leaf_fetch -> [primitive_cull ->] triangle_test -> [sphere_test ->] hit_update +
//   [packet_cull -> traversal_stack -> packet_cull]
//   memory_port <-> node_fetch, leaf_fetch [, traversal_stack] [, table_fetch]
//
// What stands in [ ] is left out when the configuration or the image does not need it (contract 5).
#pragma once

#include <optional>
#include <tuple>

#include "model/pipeline/box_test.h"
#include "model/pipeline/cell_locate.h"
#include "model/pipeline/child_sort.h"
#include "model/pipeline/hit_update.h"
#include "model/pipeline/leaf_fetch.h"
#include "model/pipeline/mask_test.h"
#include "model/pipeline/memory_port.h"
#include "model/pipeline/node_fetch.h"
#include "model/pipeline/packet_cull.h"
#include "model/pipeline/primitive_cull.h"
#include "model/pipeline/ray_queue.h"
#include "model/pipeline/result_queue.h"
#include "model/pipeline/scheduler.h"
#include "model/pipeline/sphere_test.h"
#include "model/pipeline/table_fetch.h"
#include "model/pipeline/traversal_stack.h"
#include "model/pipeline/triangle_test.h"
#include "model/pipeline/work.h"

namespace ctu::pipeline {

/// Everything that is in the unit whatever joins its stages: registers, arithmetic, and the log.
template <class Source>
struct UnitState {
  UnitState(const UnitConfig& config_, const Work& work, bool keep_events)
      : config(config_),
        bytes(work.image),
        tables(work.tester, config_.mask_test.rows, config_.mask_test.projection_tables),
        image(work.image, work.tester, Source::kComputes, work.rays.packets().most_entries),
        contexts(config_.unit.contexts),
        packets(work.rays.packets().any() ? config_.packet_cull.packets : 0),
        source(config, image, work.tester, contexts),
        log(keep_events),
        has_mask_test(config.mask_test.design != cull::Design::None),
        has_packets(work.rays.packets().any()),
        has_table_fetch(config.table_cache.bytes > 0 && !tables.tables().empty()),
        has_spills(image.stack_bound() > config.stack.entries) {}

  UnitConfig config;
  const accel::Image& bytes;
  cull::OnChipTables tables;
  UnitImage image;
  Contexts contexts;
  Packets packets;
  Source source;
  EventLog log;
  bool has_mask_test;
  bool has_packets;
  bool has_table_fetch;
  bool has_spills;
};

/// The stages of a unit, each in the holder that the wiring wants (SC_MODULEs for pins).
template <class Source, class Wiring>
struct Stages {
  template <class Stage>
  using Holder = typename Wiring::template Holder<Stage>;

  Stages(UnitState<Source>& s, reference::RayFeed& feed)
      : ray_queue(s.config, s.image, s.contexts, s.source, feed, !Source::kComputes),
        scheduler(s.config, s.contexts, s.source),
        node_fetch(s.config, s.image, s.contexts),
        box_test(s.config, s.image, s.contexts, s.source),
        child_sort(s.config, s.contexts, s.source),
        traversal_stack(s.config, s.contexts, s.packets, s.source, s.log, s.image),
        leaf_fetch(s.config, s.image, s.contexts),
        triangle_test(s.config, s.contexts, s.source),
        hit_update(s.config, s.contexts, s.source, s.log, s.image.primitive_boxes()),
        result_queue(s.config, s.contexts, s.source, s.log, s.bytes),
        memory_port(s.config, s.has_table_fetch ? Client::TableFetch
                              : s.has_spills    ? Client::Stack
                                                : Client::LeafFetch) {
    if (s.image.primitive_boxes()) primitive_cull.emplace(s.config, s.contexts, s.source);
    if (s.image.spheres() != 0) sphere_test.emplace(s.config, s.contexts, s.source);
    if (s.has_packets) packet_cull.emplace(s.config, s.image, s.contexts, s.packets, s.source, s.log);
    if (!s.has_mask_test) return;
    cell_locate.emplace(s.config, s.contexts, s.source);
    if (s.has_table_fetch) table_fetch.emplace(s.config, s.tables, s.image, s.contexts, s.source);
    mask_test.emplace(s.config, s.tables, s.contexts, s.source);
  }

  Holder<RayQueue<Source, Wiring>> ray_queue;
  std::optional<Holder<PacketCull<Source, Wiring>>> packet_cull;
  Holder<Scheduler<Source, Wiring>> scheduler;
  Holder<NodeFetch<Wiring>> node_fetch;
  Holder<BoxTest<Source, Wiring>> box_test;
  std::optional<Holder<CellLocate<Source, Wiring>>> cell_locate;
  std::optional<Holder<TableFetch<Source, Wiring>>> table_fetch;
  std::optional<Holder<MaskTest<Source, Wiring>>> mask_test;
  Holder<ChildSort<Source, Wiring>> child_sort;
  Holder<TraversalStack<Source, Wiring>> traversal_stack;
  Holder<LeafFetch<Wiring>> leaf_fetch;
  std::optional<Holder<PrimitiveCull<Source, Wiring>>> primitive_cull;
  Holder<TriangleTest<Source, Wiring>> triangle_test;
  std::optional<Holder<SphereTest<Source, Wiring>>> sphere_test;
  Holder<HitUpdate<Source, Wiring>> hit_update;
  Holder<ResultQueue<Source, Wiring>> result_queue;
  Holder<MemoryPort<Wiring>> memory_port;

  /// Every stage in its holder, those that may be left out in an optional.
  auto all() {
    return std::tie(ray_queue, packet_cull, scheduler, node_fetch, box_test, cell_locate, table_fetch, mask_test,
                    child_sort, traversal_stack, leaf_fetch, primitive_cull, triangle_test, sphere_test, hit_update,
                    result_queue, memory_port);
  }
};

/// Calls `visit(holder)` if the holder is there.
template <class Holder, class Visit>
void if_present(Holder& holder, Visit&& visit) {
  visit(holder);
}
template <class Holder, class Visit>
void if_present(std::optional<Holder>& holder, Visit&& visit) {
  if (holder) visit(*holder);
}

/// Calls `visit(stage)` for every stage that is there.
template <class Source, class Wiring, class Visit>
void for_each_stage(Stages<Source, Wiring>& stages, Visit&& visit) {
  std::apply([&](auto&... holder) { (if_present(holder, [&](auto& present) { visit(Wiring::stage(present)); }), ...); },
             stages.all());
}

/// Every ray of the feed has been returned and checked.
template <class Source, class Wiring>
bool all_returned(Stages<Source, Wiring>& stages) {
  const auto& ray_queue = Wiring::stage(stages.ray_queue);
  return ray_queue.exhausted() && Wiring::stage(stages.result_queue).rays() == ray_queue.rays_taken();
}

}  // namespace ctu::pipeline
