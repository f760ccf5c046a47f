#include "model/reference/packet_walk.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/packet/packet_slabs.h"
#include "model/reference/packet_forming.h"

namespace ctu::reference {

void check(const PacketPlan& plan) {
  if (!plan.any()) return;
  if (plan.size < kLeastPacket || plan.size > kMostPacket)
    throw Error("packets", fmt::format("of {} rays", plan.size),
                fmt::format("give {} to {}, or 0 for none", kLeastPacket, kMostPacket));
  if (plan.most_entries < 1 || plan.most_entries > kMostEntries)
    throw Error("packet entries", fmt::format("{} for a packet", plan.most_entries),
                fmt::format("give 1 to {}", kMostEntries));
}

PacketWalk::PacketWalk(const accel::Bvh4& bvh, const PacketPlan& plan, std::span<const intersect::Ray> rays,
                       const PacketList& cut, std::span<const RayTree> trees)
    : rays_(rays), trees_(trees), entries_(cut.packets()) {
  list_.first_ray = cut.first_ray;
  check(plan);
  if (stack_bound(bvh) + plan.most_entries > kMaxStackEntries)
    throw Error("BVH",
                fmt::format("a stack of depth {} with a packet's {} entries is deeper than {}", bvh.depth,
                            plan.most_entries, kMaxStackEntries),
                "allow more triangles in a leaf, or packets fewer entries");
  for (std::size_t packet = 0; packet < entries_.size(); ++packet) walk(packet, bvh, plan);
}

void PacketWalk::walk(std::size_t packet, const accel::Bvh4& bvh, const PacketPlan& plan) {
  cull::packet::PacketSlabs slabs;
  for (std::uint32_t ray = list_.first_ray[packet]; ray < list_.first_ray[packet + 1]; ++ray) {
    const intersect::PreparedRay prepared = intersect::prepare_ray(rays_[ray]);
    if (prepared.valid) slabs.add(prepared);
  }
  if (!slabs.empty()) {
    EntrySearch search;
    for (search.begin(plan.most_entries, slabs.begins(), bvh.root(tree(packet))); !search.done();) {
      const accel::Node4& node = bvh.nodes[search.node()];
      const cull::packet::PacketTimes times = slabs.test(node.boxes);
      list_.visits.push_back({search.node(), static_cast<std::uint8_t>(times.hit | times.sure << 4)});
      search.answer({node.child[0], node.child[1], node.child[2], node.child[3]}, times.hit, times.sure, times.t0);
    }
    entries_[packet] = search.entries();
  }
  for (int i = 0; i < entries_[packet].count(); ++i) list_.entries.push_back(entries_[packet][i].ref);
  list_.first_visit.push_back(list_.visits.size());
  list_.first_entry.push_back(list_.entries.size());
}

std::vector<std::uint32_t> PacketWalk::replaced(std::size_t packet) const {
  std::vector<std::uint32_t> nodes;
  const EntryList& entries = entries_[packet];
  for (std::uint64_t i = list_.first_visit[packet]; i < list_.first_visit[packet + 1]; ++i) {
    bool stays = false;
    for (int k = 0; k < entries.count(); ++k) stays |= entries[k].ref == list_.visits[i].node;
    if (!stays) nodes.push_back(list_.visits[i].node);
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

std::vector<intersect::Hit> PacketWalk::trace(const Traversal& traversal, StepList& steps) const {
  std::vector<intersect::Hit> hits;
  StepList alone;
  for (std::size_t packet = 0; packet < entries_.size(); ++packet) {
    const std::vector<std::uint32_t> above = replaced(packet);
    for (std::uint32_t ray = list_.first_ray[packet]; ray < list_.first_ray[packet + 1]; ++ray) {
      hits.push_back(traversal.trace_from(entries_[packet], rays_[ray], steps));
      alone.clear();
      if (!above.empty()) traversal.trace_in(tree(packet), rays_[ray], &alone);
      std::size_t spared = 0;
      for (const Step& step : alone.steps)
        spared += !step.is_leaf() && std::binary_search(above.begin(), above.end(), step.ref);
      steps.spared.push_back(static_cast<std::uint16_t>(std::min<std::size_t>(spared, 0xFFFF)));
    }
  }
  return hits;
}

}  // namespace ctu::reference
