// Whether and how the rays of a trace travel in packets.
#pragma once

#include "model/reference/packet_forming.h"
#include "model/reference/packet_list.h"

namespace ctu::traces {

struct RayPackets {
  reference::PacketPlan plan;  ///< of size 0: they travel alone, and the rest says nothing
  reference::Forming forming = reference::Forming::Order;
  int window = 1024;  ///< consecutive rays that are put in order together

  bool any() const { return plan.any(); }
  reference::FormingOptions how() const { return {.size = plan.size, .window = window, .forming = forming}; }
};

}  // namespace ctu::traces
