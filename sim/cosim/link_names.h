// The links and stages of the unit as both twins know them: places in the probes of unit_bench.sv.
#pragma once

#include <array>
#include <string_view>

namespace ctu::cosim {

/// In the order of rtl/links.svh. Of links that one configuration or the other lacks, the bits stay 0.
inline constexpr std::array<std::string_view, 36> kLinkNames = {
    "ray_to_scheduler", "ray_to_result",      "result_to_ray",       "scheduler_to_node", "scheduler_to_leaf",
    "node_to_box",      "box_to_locate",      "locate_to_table",     "table_to_mask",     "locate_to_mask",
    "mask_to_sort",     "box_to_sort",        "sort_to_stack",       "leaf_to_triangle",  "triangle_to_hit",
    "hit_to_stack",     "stack_to_scheduler", "stack_to_result",     "node_to_memory",    "memory_to_node",
    "leaf_to_memory",   "memory_to_leaf",     "stack_to_memory",     "memory_to_stack",   "table_to_memory",
    "memory_to_table",  "leaf_to_cull",       "cull_to_triangle",    "cull_to_hit",       "triangle_to_sphere",
    "sphere_to_hit",    "ray_to_packet",      "packet_to_scheduler", "node_to_packet",    "packet_to_stack",
    "stack_to_packet"};
inline constexpr int kLinks = 36;

inline constexpr std::array<std::string_view, 17> kStageNames = {
    "ray_queue",    "scheduler",   "node_fetch",      "box_test",    "cell_locate",   "table_fetch",
    "mask_test",    "child_sort",  "traversal_stack", "leaf_fetch",  "triangle_test", "hit_update",
    "result_queue", "memory_port", "primitive_cull",  "sphere_test", "packet_cull"};
inline constexpr int kStages = 17;

}  // namespace ctu::cosim
