// The whole unit: every stage, every link, and one cycle of all of them.
//
//   ray_queue -> scheduler -> node_fetch -> box_test -> [cell_locate -> mask_test ->] child_sort -> traversal_stack
//                    |  ^         |                                                                  |  ^    |
//                    |  +---------|------------------------------------------------------------------+  |    +-> result_queue
//                    +-> leaf_fetch -> triangle_test -> hit_update ------------------------------------+
//                  memory_port <-> node_fetch, leaf_fetch [, traversal_stack]
//
// What stands in [ ] is left out when the configuration or the image does not need it (contract 5).
#pragma once

#include <cassert>
#include <string>
#include <tuple>
#include <vector>

#include "model/pipeline/box_test.h"
#include "model/pipeline/cell_locate.h"
#include "model/pipeline/child_sort.h"
#include "model/pipeline/hit_update.h"
#include "model/pipeline/leaf_fetch.h"
#include "model/pipeline/mask_test.h"
#include "model/pipeline/memory_port.h"
#include "model/pipeline/node_fetch.h"
#include "model/pipeline/ray_queue.h"
#include "model/pipeline/result_queue.h"
#include "model/pipeline/scheduler.h"
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
        tester(work.tester),
        image(work.image, Source::kComputes),
        contexts(config_.unit.contexts),
        source(config, image, work.tester, contexts),
        log(keep_events),
        has_mask_test(config.mask_test.design != cull::Design::None) {}

  UnitConfig config;
  const accel::Image& bytes;
  const cull::MaskTester& tester;
  UnitImage image;
  Contexts contexts;
  Source source;
  EventLog log;
  bool has_mask_test;
};

/// The stages of a unit, each in the holder that the wiring wants (SC_MODULEs for pins).
template <class Source, class Wiring>
struct Stages {
  template <class Stage>
  using Holder = typename Wiring::template Holder<Stage>;

  Stages(UnitState<Source>& s, reference::RayFeed& feed)
      : ray_queue(s.config, s.contexts, s.source, feed, !Source::kComputes),
        scheduler(s.config, s.contexts, s.source),
        node_fetch(s.config, s.image, s.contexts),
        box_test(s.config, s.contexts, s.source),
        cell_locate(s.config, s.contexts, s.source),
        mask_test(s.config, s.tester, s.contexts, s.source),
        child_sort(s.config, s.contexts, s.source),
        traversal_stack(s.config, s.contexts, s.source, s.log, s.image),
        leaf_fetch(s.config, s.image, s.contexts),
        triangle_test(s.config, s.contexts, s.source),
        hit_update(s.config, s.contexts, s.source, s.log),
        result_queue(s.config, s.contexts, s.source, s.log, s.bytes),
        memory_port(s.config, kClients - (s.image.stack_bound() > s.config.stack.entries ? 0 : 1)) {}

  Holder<RayQueue<Source, Wiring>> ray_queue;
  Holder<Scheduler<Source, Wiring>> scheduler;
  Holder<NodeFetch<Wiring>> node_fetch;
  Holder<BoxTest<Source, Wiring>> box_test;
  Holder<CellLocate<Source, Wiring>> cell_locate;
  Holder<MaskTest<Source, Wiring>> mask_test;
  Holder<ChildSort<Source, Wiring>> child_sort;
  Holder<TraversalStack<Source, Wiring>> traversal_stack;
  Holder<LeafFetch<Wiring>> leaf_fetch;
  Holder<TriangleTest<Source, Wiring>> triangle_test;
  Holder<HitUpdate<Source, Wiring>> hit_update;
  Holder<ResultQueue<Source, Wiring>> result_queue;
  Holder<MemoryPort<Wiring>> memory_port;

  auto all() {
    return std::tie(ray_queue, scheduler, node_fetch, box_test, cell_locate, mask_test, child_sort, traversal_stack,
                    leaf_fetch, triangle_test, hit_update, result_queue, memory_port);
  }
};

}  // namespace ctu::pipeline
