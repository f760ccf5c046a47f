#include "model/pipeline/accounting.h"

#include <numeric>

namespace ctu::pipeline {
namespace {

struct Term {
  std::string_view name, description;
};

constexpr Term kActivityTerms[kActivities] = {
    {"busy", "work moved on"},
    {"idle", "no work here"},
    {"output_full", "the link behind the stage is full"},
    {"no_context", "rays wait and no context is free"},
    {"bank_conflict", "lanes ask one bank of a table more often than it has ports"},
    {"mshrs_full", "a line misses and no miss register is free"},
    {"memory_port_full", "the request link to memory is full"},
    {"fill_port", "the tag array takes a line that arrives from memory"},
    {"memory", "nothing to do but wait for memory"},
    {"spill", "the short stack is full and entries go to memory first"},
    {"interval", "work waits for the initiation interval to end"},
    {"no_packet", "rays wait and the registers of all packets are taken"},
};

constexpr Term kPlaceTerms[kPlaces] = {
    {"ray_setup", "in ray_queue, from the context to the scheduler"},
    {"scheduler", "ready, waiting to be issued to a fetch stage"},
    {"node_fetch_hit", "fetching a node all of whose lines are in the cache"},
    {"node_fetch_miss", "fetching a node with at least one line from memory"},
    {"box_test", "in the box test"},
    {"cell_locate", "finding begin and end cells, or touched cells"},
    {"table_fetch_hit", "fetching table rows all of whose lines are in the cache"},
    {"table_fetch_miss", "fetching table rows with at least one line from memory"},
    {"mask_test", "in the mask test, table conflicts included"},
    {"child_sort", "in the sort of the surviving children"},
    {"traversal_stack", "waiting for the stack, pushing, dropping, popping"},
    {"stack_refill", "waiting for spilled entries from memory"},
    {"leaf_fetch_hit", "fetching a leaf all of whose lines are in the cache"},
    {"leaf_fetch_miss", "fetching a leaf with at least one line from memory"},
    {"primitive_cull", "holding the ray's box against those of the leaf's primitives"},
    {"triangle_test", "in the triangle test, from the leaf's first triangle to its last outcome"},
    {"sphere_test", "in the sphere test, from the leaf's last outcome on"},
    {"hit_update", "the outcome of the leaf is being written"},
    {"result", "finished, waiting to be returned"},
    {"packet_cull", "waiting until the packet is whole, has found its entries, and the stack takes them"},
};

}  // namespace

std::string_view name_of(Activity activity) { return kActivityTerms[static_cast<int>(activity)].name; }
std::string_view description_of(Activity activity) { return kActivityTerms[static_cast<int>(activity)].description; }
std::string_view name_of(Place place) { return kPlaceTerms[static_cast<int>(place)].name; }
std::string_view description_of(Place place) { return kPlaceTerms[static_cast<int>(place)].description; }

void Account::rest_idle(Cycle end) {
  std::uint64_t& idle = cycles_[static_cast<int>(Activity::Idle)];
  idle = 0;
  idle = end - std::accumulate(cycles_.begin(), cycles_.end(), std::uint64_t{0});
}

StageAccount Account::close() const {
  StageAccount account;
  account.stage = std::string(stage_);
  account.busy = cycles_[static_cast<int>(Activity::Busy)];
  account.idle = cycles_[static_cast<int>(Activity::Idle)];
  for (const Activity cause : causes_)
    account.stalled.push_back(
        {std::string(name_of(cause)), std::string(description_of(cause)), cycles_[static_cast<int>(cause)]});
  return account;
}

}  // namespace ctu::pipeline
