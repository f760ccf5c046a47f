// Which port is joined to which: the one list of the unit's links. Their numbers are their places in this list.
#pragma once

#include "model/pipeline/pipeline.h"

namespace ctu::pipeline {

/// Calls `join(name, out, in)` for every link of the unit, left-out parts excepted.
template <class Source, class Wiring, class Join>
void for_each_link(Stages<Source, Wiring>& stages, bool has_spills, Join&& join) {
  auto& ray_queue = Wiring::stage(stages.ray_queue);
  auto& scheduler = Wiring::stage(stages.scheduler);
  auto& node_fetch = Wiring::stage(stages.node_fetch);
  auto& box_test = Wiring::stage(stages.box_test);
  auto& child_sort = Wiring::stage(stages.child_sort);
  auto& stack = Wiring::stage(stages.traversal_stack);
  auto& leaf_fetch = Wiring::stage(stages.leaf_fetch);
  auto& triangle_test = Wiring::stage(stages.triangle_test);
  auto& hit_update = Wiring::stage(stages.hit_update);
  auto& result_queue = Wiring::stage(stages.result_queue);
  auto& memory_port = Wiring::stage(stages.memory_port);
  constexpr int kNode = static_cast<int>(Client::NodeFetch), kLeaf = static_cast<int>(Client::LeafFetch),
                kStack = static_cast<int>(Client::Stack), kTable = static_cast<int>(Client::TableFetch);

  if (stages.packet_cull)
    join("packet_to_scheduler", Wiring::stage(*stages.packet_cull).to_scheduler, scheduler.from_rays);
  else
    join("ray_to_scheduler", ray_queue.to_scheduler, scheduler.from_rays);
  join("ray_to_result", ray_queue.to_result, result_queue.from_rays);
  join("result_to_ray", result_queue.freed, ray_queue.freed);
  join("scheduler_to_node", scheduler.to_node_fetch, node_fetch.requests);
  join("scheduler_to_leaf", scheduler.to_leaf_fetch, leaf_fetch.requests);
  join("node_to_box", node_fetch.done, box_test.node);
  if (stages.mask_test) {
    auto& cell_locate = Wiring::stage(*stages.cell_locate);
    auto& mask_test = Wiring::stage(*stages.mask_test);
    join("box_to_locate", box_test.tested, cell_locate.tested);
    if (stages.table_fetch) {
      auto& table_fetch = Wiring::stage(*stages.table_fetch);
      join("locate_to_table", cell_locate.located, table_fetch.requests);
      join("table_to_mask", table_fetch.done, mask_test.located);
    } else {
      join("locate_to_mask", cell_locate.located, mask_test.located);
    }
    join("mask_to_sort", mask_test.survivors, child_sort.survivors);
  } else {
    join("box_to_sort", box_test.tested, child_sort.survivors);
  }
  join("sort_to_stack", child_sort.sorted, stack.sorted);
  if (stages.primitive_cull) {
    auto& primitive_cull = Wiring::stage(*stages.primitive_cull);
    join("leaf_to_cull", leaf_fetch.done, primitive_cull.leaf);
    join("cull_to_triangle", primitive_cull.passed, triangle_test.leaf);
    join("cull_to_hit", primitive_cull.missed, hit_update.missed);
  } else {
    join("leaf_to_triangle", leaf_fetch.done, triangle_test.leaf);
  }
  if (stages.sphere_test) {
    auto& sphere_test = Wiring::stage(*stages.sphere_test);
    join("triangle_to_sphere", triangle_test.tested, sphere_test.tested);
    join("sphere_to_hit", sphere_test.outcome, hit_update.tested);
  } else {
    join("triangle_to_hit", triangle_test.tested, hit_update.tested);
  }
  join("hit_to_stack", hit_update.done, stack.leaf_done);
  join("stack_to_scheduler", stack.to_scheduler, scheduler.from_stack);
  join("stack_to_result", stack.to_result, result_queue.from_stack);
  join("node_to_memory", node_fetch.misses, memory_port.requests[kNode]);
  join("memory_to_node", memory_port.answers[kNode], node_fetch.fills);
  join("leaf_to_memory", leaf_fetch.misses, memory_port.requests[kLeaf]);
  join("memory_to_leaf", memory_port.answers[kLeaf], leaf_fetch.fills);
  if (has_spills) {
    join("stack_to_memory", stack.spills, memory_port.requests[kStack]);
    join("memory_to_stack", memory_port.answers[kStack], stack.refills);
  }
  if (stages.table_fetch) {
    auto& table_fetch = Wiring::stage(*stages.table_fetch);
    join("table_to_memory", table_fetch.misses, memory_port.requests[kTable]);
    join("memory_to_table", memory_port.answers[kTable], table_fetch.fills);
  }
  if (stages.packet_cull) {
    auto& packet_cull = Wiring::stage(*stages.packet_cull);
    join("ray_to_packet", ray_queue.to_packets, packet_cull.rays);
    join("node_to_packet", node_fetch.to_packets, packet_cull.nodes);
    join("packet_to_stack", packet_cull.starts, stack.starts);
    join("stack_to_packet", stack.released, packet_cull.released);
  }
}

}  // namespace ctu::pipeline
