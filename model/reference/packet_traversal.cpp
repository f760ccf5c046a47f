#include "model/reference/packet_traversal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "model/reference/primitive_test.h"
#include "model/reference/visit_order.h"

namespace ctu::reference {
namespace {

using accel::ChildRef;
using cull::packet::Answer;
using cull::packet::Bounds;
using cull::packet::Box;
using cull::packet::Lines;
using cull::packet::Reach;
using cull::packet::Sphere;
using cull::packet::Triangle;
using intersect::kLanes;
using intersect::Ray;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Parts of a packet: all of it, its halves, their halves. Part p of 2^level rays holds rays [p << level, ...).
constexpr int kMostLevel = std::bit_width(static_cast<unsigned>(kMostPacket)) - 1;
constexpr int kLeastLevel = std::bit_width(static_cast<unsigned>(kLeastPacket)) - 1;

struct StackEntry {
  ChildRef ref;
  float t0;
  int level;  ///< of the part that the ray travels with from here on
};

struct Traveller {
  intersect::PreparedRay ray;
  intersect::Hit best;
  std::vector<StackEntry> stack;

  /// What it visits next; null when it is done. What lies beyond its hit is dropped.
  StackEntry* next() {
    while (!stack.empty() && !(stack.back().t0 <= best.t)) stack.pop_back();
    return stack.empty() ? nullptr : &stack.back();
  }
};

/// The smallest box around all children.
Box box_of(const accel::Node4& node) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = *std::min_element(node.boxes.lo[axis], node.boxes.lo[axis] + kLanes);  // empty lanes are +inf
    box.hi[axis] = *std::max_element(node.boxes.hi[axis], node.boxes.hi[axis] + kLanes);
  }
  return box;
}

Box box_of(const accel::Node4& node, int lane) {
  return {{node.boxes.lo[0][lane], node.boxes.lo[1][lane], node.boxes.lo[2][lane]},
          {node.boxes.hi[0][lane], node.boxes.hi[1][lane], node.boxes.hi[2][lane]}};
}

class PacketWalk {
 public:
  PacketWalk(const NodeTest& test_node, const PacketOptions& options, std::span<const Ray> rays, PacketCounts& counts,
             PacketObserver* observer)
      : test_node_(test_node),
        bvh_(test_node.bvh()),
        options_(options),
        rays_(rays),
        counts_(counts),
        observer_(observer),
        whole_level_(std::bit_width(rays.size() - 1)),
        travellers_(rays.size()) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Traveller& traveller = travellers_[i];
      traveller.ray = intersect::prepare_ray(rays[i]);
      traveller.best.t = rays[i].tmax;
      traveller.stack.push_back({0, rays[i].tmin, whole_level_});
    }
    counts_.rays += rays.size();
    ++counts_.packets;
  }

  void run(std::span<intersect::Hit> hits) {
    for (Group group = largest_group(); !group.members.empty(); group = largest_group()) visit(group);
    for (std::size_t i = 0; i < travellers_.size(); ++i) hits[i] = travellers_[i].best;
  }

 private:
  /// Rays of one part that have come to the same place.
  struct Group {
    ChildRef ref = 0;
    int level = 0;
    std::size_t part = 0;
    std::vector<std::size_t> members;
  };

  /// The most rays that are at one place; of equal ones that with the first ray. It decides how much is asked together,
  /// not what any ray finds.
  Group largest_group() {
    std::map<std::array<std::size_t, 3>, Group> groups;
    for (std::size_t i = 0; i < travellers_.size(); ++i) {
      const StackEntry* next = travellers_[i].next();
      if (next == nullptr) continue;
      const std::size_t part = i >> next->level;
      Group& group = groups[{next->ref, static_cast<std::size_t>(next->level), part}];
      group.ref = next->ref, group.level = next->level, group.part = part;
      group.members.push_back(i);
    }
    Group* largest = nullptr;
    const auto before = [](const Group& a, const Group& b) {
      if (a.members.size() != b.members.size()) return a.members.size() > b.members.size();
      return a.members.front() < b.members.front();
    };
    for (auto& [key, group] : groups)
      if (largest == nullptr || before(group, *largest)) largest = &group;
    return largest == nullptr ? Group{} : std::move(*largest);
  }

  void visit(const Group& group) {
    const bool together = group.members.size() >= static_cast<std::size_t>(options_.least_rays);
    if (together && splits(group)) {
      ++counts_.splits;
      for (const std::size_t i : group.members) --travellers_[i].stack.back().level;
      return;
    }
    for (const std::size_t i : group.members) travellers_[i].stack.pop_back();
    if (accel::is_leaf(group.ref))
      visit_leaf(group, together);
    else
      visit_node(group, together);
  }

  bool splits(const Group& group) {
    if (!options_.splits || group.level <= kLeastLevel || accel::is_leaf(group.ref)) return false;
    return part_of(group).planes.surrounds(box_of(bvh_.nodes[group.ref]));
  }

  void visit_node(const Group& group, bool together) {
    const accel::Node4& node = bvh_.nodes[group.ref];
    unsigned culled = 0, children = 0;
    for (int lane = 0; lane < kLanes; ++lane)
      if (node.child[lane] != accel::kEmptyChild) children |= 1u << lane;
    if (together) {
      ++counts_.node_visits;
      const Asking asking(*this, group);
      for (int lane = 0; lane < kLanes; ++lane)
        if ((children >> lane & 1u) != 0 &&
            asking.all_miss(box_of(node, lane), counts_.box_questions, counts_.box_misses))
          culled |= 1u << lane;
    }
    const auto boxes = static_cast<std::uint64_t>(std::popcount(children & ~culled));
    counts_.box_tests += boxes * group.members.size();
    counts_.saved_box_tests += static_cast<std::uint64_t>(std::popcount(culled)) * group.members.size();
    if (culled == children) {
      counts_.saved_node_tests += group.members.size();
      return;
    }
    counts_.node_tests += group.members.size();
    if (!together) counts_.alone_node_tests += group.members.size();
    for (const std::size_t i : group.members) {
      Traveller& traveller = travellers_[i];
      intersect::SlabTimes times;
      const cull::MaskTestResult outcome = test_node_(traveller.ray, group.ref, traveller.best.t, times);
      const VisitOrder order = sort_survivors(outcome.pass & ~culled, times.t0);
      for (int k = order.count - 1; k >= 0; --k)
        traveller.stack.push_back({node.child[order.lane[k]], times.t0[order.lane[k]], group.level});
    }
  }

  void visit_leaf(const Group& group, bool together) {
    const std::uint32_t first = accel::leaf_first(group.ref);
    const int count = accel::leaf_count(group.ref);
    unsigned culled = 0;
    if (together) {
      ++counts_.leaf_visits;
      const Asking asking(*this, group);
      for (int k = 0; k < count; ++k) {
        const accel::LeafTriangle& p = bvh_.triangles[first + static_cast<std::uint32_t>(k)];
        const auto missed = [&](const auto& shape) {
          return asking.all_miss(shape, counts_.primitive_questions, counts_.primitive_misses);
        };
        if (p.is_sphere() ? missed(Sphere{p.sphere().centre, p.sphere().radius}) : missed(Triangle{{p.v0, p.v1, p.v2}}))
          culled |= 1u << k;
      }
    }
    const auto skipped = static_cast<std::uint64_t>(std::popcount(culled)), members = group.members.size();
    const std::uint64_t tests = members * (static_cast<std::uint64_t>(count) - skipped);
    counts_.primitive_tests += tests;
    counts_.saved_primitive_tests += members * skipped;
    if (!together) counts_.alone_primitive_tests += tests;
    for (const std::size_t i : group.members) test_leaf(travellers_[i], first, count, culled);
  }

  void test_leaf(Traveller& traveller, std::uint32_t first, int count, unsigned culled) const {
    for (int k = 0; k < count; ++k) {
      if ((culled >> k & 1u) != 0) continue;
      test_primitive<true>(traveller.ray, bvh_.triangles[first + static_cast<std::uint32_t>(k)], traveller.best);
    }
    const bool any_hit = traveller.ray.ray.kind == intersect::RayKind::AnyHit;
    if (any_hit && traveller.best.primitive != intersect::kNoPrimitive) traveller.stack.clear();
  }

  /// What is made once for each part of the packet that is asked.
  struct Part {
    Part(std::span<const Ray> rays, const PacketOptions& options)
        : lines(make_lines(rays, scale_of(options.method))),
          bounds(options.method, lines),
          planes(scale_of(options.method) == cull::packet::Scale::MajorAxis
                     ? lines
                     : make_lines(rays, cull::packet::Scale::MajorAxis)) {}
    Lines lines;
    Bounds bounds;
    cull::packet::BoundingPlanes planes;
  };

  static std::size_t number_of(int level, std::size_t part) { return (std::size_t{1} << (kMostLevel - level)) + part; }

  std::span<const Ray> rays_of(const Group& group) const {
    const std::size_t begin = group.part << group.level;
    return rays_.subspan(begin, std::min(std::size_t{1} << group.level, rays_.size() - begin));
  }

  const Part& part_of(const Group& group) {
    std::optional<Part>& part = parts_[number_of(group.level, group.part)];
    if (!part) part.emplace(rays_of(group), options_);
    return *part;
  }

  /// A group's questions at one place.
  class Asking {
   public:
    Asking(PacketWalk& walk, const Group& group) : walk_(walk), part_(walk.part_of(group)), reach_(Reach::none()) {
      const std::size_t begin = group.part << group.level;
      limits_.fill(-kInfinity);
      for (const std::size_t i : group.members) {
        limits_[i - begin] = walk.travellers_[i].best.t;
        part_.lines.extend(reach_, i - begin, limits_[i - begin]);
      }
      const std::span<const Ray> rays = walk.rays_of(group);
      place_ = {rays, static_cast<std::uint32_t>(number_of(group.level, group.part)), {limits_.data(), rays.size()}};
    }
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;

    template <class Primitive>
    bool all_miss(const Primitive& primitive, std::uint64_t& questions, std::uint64_t& misses) const {
      if (walk_.observer_ != nullptr) show(primitive);
      if (!walk_.options_.culls) return false;
      ++questions;
      const bool miss = part_.bounds.test(primitive, reach_) == Answer::AllMiss;
      misses += miss;
      return miss;
    }

   private:
    void show(const Box& box) const { walk_.observer_->box(place_, box); }
    void show(const Triangle& triangle) const { walk_.observer_->triangle(place_, triangle); }
    void show(const Sphere& sphere) const { walk_.observer_->sphere(place_, sphere); }

    PacketWalk& walk_;
    const Part& part_;
    Reach reach_;
    std::array<float, kMostPacket> limits_;
    PacketPlace place_;
  };

  const NodeTest& test_node_;
  const accel::Bvh4& bvh_;
  const PacketOptions& options_;
  const std::span<const Ray> rays_;
  PacketCounts& counts_;
  PacketObserver* const observer_;
  const int whole_level_;
  std::vector<Traveller> travellers_;
  std::array<std::optional<Part>, 2 * kMostPacket> parts_;
};

}  // namespace

PacketCounts& PacketCounts::operator+=(const PacketCounts& other) {
  rays += other.rays;
  packets += other.packets;
  splits += other.splits;
  node_visits += other.node_visits;
  leaf_visits += other.leaf_visits;
  box_questions += other.box_questions;
  box_misses += other.box_misses;
  primitive_questions += other.primitive_questions;
  primitive_misses += other.primitive_misses;
  node_tests += other.node_tests;
  primitive_tests += other.primitive_tests;
  alone_node_tests += other.alone_node_tests;
  alone_primitive_tests += other.alone_primitive_tests;
  saved_node_tests += other.saved_node_tests;
  saved_primitive_tests += other.saved_primitive_tests;
  box_tests += other.box_tests;
  saved_box_tests += other.saved_box_tests;
  return *this;
}

PacketTraversal::PacketTraversal(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester,
                                 const PacketOptions& options)
    : test_node_(bvh, masks, tester), options_(options) {}

void PacketTraversal::trace(std::span<const Ray> rays, std::span<intersect::Hit> hits, PacketCounts& counts,
                            PacketObserver* observer) const {
  if (observer != nullptr) observer->begin_packet();
  PacketWalk(test_node_, options_, rays, counts, observer).run(hits);
}

void PacketTraversal::trace(std::span<const Ray> rays, const FormingOptions& forming, std::span<intersect::Hit> hits,
                            PacketCounts& counts, PacketObserver* observer) const {
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = {rays[i].tmax, 0, 0, intersect::kNoPrimitive};
  std::vector<Ray> packet;
  std::vector<intersect::Hit> found;
  for (const std::vector<std::uint32_t>& members : form_packets(rays, forming)) {
    packet.clear();
    for (const std::uint32_t i : members) packet.push_back(rays[i]);
    found.assign(members.size(), {});
    trace(packet, found, counts, observer);
    for (std::size_t i = 0; i < members.size(); ++i) hits[members[i]] = found[i];
  }
}

}  // namespace ctu::reference
