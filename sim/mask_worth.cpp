#include "sim/mask_worth.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "model/base/parallel.h"
#include "model/intersect/triangle_test.h"
#include "model/reference/traversal.h"

namespace ctu::sim {
namespace {

using accel::ChildRef;
using intersect::kLanes;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kRaysPerChunk = 1024;
constexpr int kRounds = 3;  ///< a mask's worth depends on the masks below and above it; two rounds settle all but a few
constexpr double kLikeMasks = 16;  ///< visits for which masks like it speak in a mask's estimate

/// A visit of the walk without culling, with what the masks would have said.
struct Visit {
  ChildRef ref = 0;
  std::uint32_t parent = kNone;  ///< place of the parent's visit in the chunk
  std::uint8_t lane = 0;         ///< of the parent
  std::uint8_t culled = 0, asked = 0;
};

struct Place {
  std::uint32_t node = 0;
  std::uint8_t lane = 0;
};

/// Where each node and each leaf hangs in the tree.
class Parents {
 public:
  explicit Parents(const accel::Bvh4& bvh) : of_node_(bvh.nodes.size()), of_leaf_(bvh.triangles.size()) {
    for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node)
      for (std::uint8_t lane = 0; lane < kLanes; ++lane) {
        const ChildRef child = bvh.nodes[node].child[lane];
        if (child == accel::kEmptyChild) continue;
        (accel::is_leaf(child) ? of_leaf_[accel::leaf_first(child)] : of_node_[child]) = {node, lane};
      }
  }
  Place of(ChildRef ref) const { return accel::is_leaf(ref) ? of_leaf_[accel::leaf_first(ref)] : of_node_[ref]; }

 private:
  std::vector<Place> of_node_, of_leaf_;
};

/// Follows the recorded walk of each ray and asks the masks at every node of it.
class Asker {
 public:
  Asker(const accel::Bvh4& bvh, const cull::ObjectMasks& masks, const cull::MaskTester& tester, const Parents& parents)
      : bvh_(bvh), masks_(masks), tester_(tester), parents_(parents) {}

  void follow(const intersect::Ray& ray, const reference::StepList& steps, std::vector<Visit>& visits) {
    const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
    float best = ray.tmax;
    path_.clear();
    for (const reference::Step& step : steps.steps) {
      Visit visit;
      visit.ref = step.ref;
      place(visit, visits);
      if (step.is_leaf()) {
        if (step.became_best() != 0) best = hit_of(prepared, step, best);
      } else {
        ask(prepared, best, visit);
        path_.push_back(static_cast<std::uint32_t>(visits.size()));
      }
      visits.push_back(visit);
    }
  }

 private:
  /// The walk goes depth first, so the parent is the last visit of its node on the path.
  void place(Visit& visit, const std::vector<Visit>& visits) {
    if (visit.ref == 0) return;  // the root
    const Place parent = parents_.of(visit.ref);
    while (visits[path_.back()].ref != parent.node) path_.pop_back();
    visit.parent = path_.back();
    visit.lane = parent.lane;
  }

  void ask(const intersect::PreparedRay& ray, float best, Visit& visit) const {
    const intersect::Box4& boxes = bvh_.nodes[visit.ref].boxes;
    const intersect::SlabTimes times = intersect::slab_test(ray, boxes, best);
    const cull::NodeMasks masks = masks_.of(visit.ref);
    visit.culled = static_cast<std::uint8_t>(times.hit & ~tester_.test(ray, times, boxes, masks).pass);
    visit.asked = static_cast<std::uint8_t>(times.hit & ~cull::full_lanes(masks.bits, masks_.resolution));
  }

  float hit_of(const intersect::PreparedRay& ray, const reference::Step& leaf, float best) const {
    const int last = std::bit_width(leaf.became_best()) - 1;
    const accel::LeafTriangle& triangle =
        bvh_.triangles[accel::leaf_first(leaf.ref) + static_cast<std::uint32_t>(last)];
    return intersect::triangle_test(ray, triangle.v0, triangle.v1, triangle.v2, best).t;
  }

  const accel::Bvh4& bvh_;
  const cull::ObjectMasks& masks_;
  const cull::MaskTester& tester_;
  const Parents& parents_;
  std::vector<std::uint32_t> path_;  ///< visits of nodes from the root down
};

using Chunks = std::vector<std::vector<Visit>>;

Chunks ask_everywhere(const accel::Bvh4& bvh, const cull::ObjectMasks& masks, const cull::MaskTester& tester,
                      const RaySample& sample, int threads) {
  const cull::MaskTester no_culling(cull::Design::None, tester.options());
  const reference::Traversal walk(bvh, nullptr, no_culling);
  const Parents parents(bvh);
  Chunks chunks((sample.rays.size() + kRaysPerChunk - 1) / kRaysPerChunk);
  parallel_chunks(sample.rays.size(), kRaysPerChunk, threads, [&](std::size_t first, std::size_t last) {
    Asker asker(bvh, masks, tester, parents);
    for (std::size_t i = first; i < last; ++i) {
      reference::StepList steps;
      walk.trace(sample.rays[i], &steps);
      asker.follow(sample.rays[i], steps, chunks[first / kRaysPerChunk]);
    }
  });
  return chunks;
}

/// What is known of a lane: sums over visits of its node.
struct LaneSum {
  double visits = 0, asked = 0, saved = 0;
  void operator+=(const LaneSum& other) {
    visits += other.visits;
    asked += other.asked;
    saved += other.saved;
  }
};
using NodeSums = std::array<LaneSum, kLanes>;

/// Lanes that are like each other: how full their masks are, how many triangles lie below.
class LaneClasses {
 public:
  LaneClasses(const accel::Bvh4& bvh, const cull::ObjectMasks& masks)
      : bvh_(bvh), masks_(masks), triangles_below_(bvh.nodes.size()) {
    for (std::size_t node = bvh.nodes.size(); node-- > 0;)
      for (const ChildRef child : bvh.nodes[node].child)
        if (child != accel::kEmptyChild) triangles_below_[node] += triangles(child);
  }

  std::size_t count() const { return kFills * kSizes; }
  std::size_t of(std::uint32_t node, int lane) const {
    const std::uint64_t* mask = masks_.mask(node, lane);
    int set = 0;
    for (int word = 0; word < masks_.words; ++word) set += std::popcount(mask[word]);
    const int cells = masks_.resolution * masks_.resolution * masks_.resolution;
    const auto fill = static_cast<std::size_t>(set * (static_cast<int>(kFills) - 1) / cells);
    const auto size = static_cast<std::size_t>(std::bit_width(triangles(bvh_.nodes[node].child[lane])));
    return fill * kSizes + std::min(size, kSizes - 1);
  }

 private:
  static constexpr std::size_t kFills = 17, kSizes = 32;  ///< sixteenths; powers of two

  std::uint32_t triangles(ChildRef ref) const {
    return accel::is_leaf(ref) ? static_cast<std::uint32_t>(accel::leaf_count(ref)) : triangles_below_[ref];
  }

  const accel::Bvh4& bvh_;
  const cull::ObjectMasks& masks_;
  std::vector<std::uint32_t> triangles_below_;
};

/// Weighs masks against each other, round by round.
class Scales {
 public:
  Scales(const accel::Bvh4& bvh, const cull::ObjectMasks& masks, const VisitCosts& costs, const Chunks& chunks)
      : bvh_(bvh), masks_(masks), costs_(costs), chunks_(chunks), classes_(bvh, masks), kept_(bvh.nodes.size()) {
    number_of_.assign(bvh.nodes.size(), kNone);
    for (const auto& chunk : chunks)
      for (const Visit& visit : chunk)
        if (!accel::is_leaf(visit.ref) && number_of_[visit.ref] == kNone) number_of_[visit.ref] = visited_++;
    for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node) kept_[node] = lanes_to_judge(node);
  }

  std::vector<std::uint8_t> judge() {
    for (int round = 0; round < kRounds; ++round) {
      sums_.assign(visited_, {});
      for (const auto& chunk : chunks_) add(chunk);
      decide();
    }
    return std::move(kept_);
  }

 private:
  /// Lanes with a child whose mask is not full.
  std::uint8_t lanes_to_judge(std::uint32_t node) const {
    unsigned there = 0;
    for (int lane = 0; lane < kLanes; ++lane)
      there |= (bvh_.nodes[node].child[lane] != accel::kEmptyChild ? 1u : 0u) << lane;
    return static_cast<std::uint8_t>(there & ~cull::full_lanes(masks_.mask(node, 0), masks_.resolution));
  }

  bool culls(const Visit& parent, int lane) const { return (parent.culled & kept_[parent.ref]) >> lane & 1; }

  double own_cost(const Visit& visit) const {
    if (accel::is_leaf(visit.ref)) return costs_.leaf + costs_.triangle * accel::leaf_count(visit.ref);
    const unsigned kept = kept_[visit.ref];
    return costs_.node + (kept != 0 ? costs_.mask_bytes : 0) + costs_.look_up * std::popcount(visit.asked & kept);
  }

  /// Adds to the sums of the nodes that the walk reaches with the masks kept so far, with what is below each child.
  void add(const std::vector<Visit>& chunk) {
    std::vector<bool> reached(chunk.size());
    std::vector<double> cost(chunk.size());
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      const Visit& visit = chunk[i];
      reached[i] = visit.parent == kNone || (reached[visit.parent] && !culls(chunk[visit.parent], visit.lane));
      if (!reached[i] || accel::is_leaf(visit.ref)) continue;
      NodeSums& sums = sums_[number_of_[visit.ref]];
      for (unsigned lane = 0; lane < kLanes; ++lane) sums[lane] += {1, static_cast<double>(visit.asked >> lane & 1), 0};
    }
    for (std::size_t i = chunk.size(); i-- > 0;) {
      const Visit& visit = chunk[i];
      cost[i] += own_cost(visit);
      if (visit.parent == kNone) continue;
      const Visit& parent = chunk[visit.parent];
      if (!culls(parent, visit.lane)) cost[visit.parent] += cost[i];
      if (reached[visit.parent] && (parent.culled >> visit.lane & 1) != 0)
        sums_[number_of_[parent.ref]][visit.lane].saved += cost[i];
    }
  }

  void decide() {
    std::vector<LaneSum> like(classes_.count());
    for (std::uint32_t node = 0; node < kept_.size(); ++node) {
      if (number_of_[node] == kNone) continue;
      for_each_lane(lanes_to_judge(node), [&](unsigned lane) {
        like[classes_.of(node, static_cast<int>(lane))] += sums_[number_of_[node]][lane];
      });
    }
    for (std::uint32_t node = 0; node < kept_.size(); ++node) kept_[node] = lanes_kept(node, like);
  }

  std::uint8_t lanes_kept(std::uint32_t node, const std::vector<LaneSum>& like) const {
    unsigned kept = 0;
    double worth = 0;
    for_each_lane(lanes_to_judge(node), [&](unsigned lane) {
      LaneSum sum = like[classes_.of(node, static_cast<int>(lane))];
      const double weight = sum.visits == 0 ? 0 : kLikeMasks / sum.visits;
      sum = {weight * sum.visits, weight * sum.asked, weight * sum.saved};
      if (number_of_[node] != kNone) sum += sums_[number_of_[node]][lane];
      if (sum.visits == 0) return;
      const double net = (sum.saved - costs_.look_up * sum.asked) / sum.visits;
      if (net <= 0) return;
      kept |= 1u << lane;
      worth += net;
    });
    return worth > costs_.mask_bytes ? static_cast<std::uint8_t>(kept) : std::uint8_t{0};
  }

  template <class Body>
  static void for_each_lane(unsigned lanes, Body&& body) {
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1) body(static_cast<unsigned>(std::countr_zero(rest)));
  }

  const accel::Bvh4& bvh_;
  const cull::ObjectMasks& masks_;
  const VisitCosts& costs_;
  const Chunks& chunks_;
  LaneClasses classes_;
  std::vector<std::uint32_t> number_of_;  ///< of a node among those visited
  std::uint32_t visited_ = 0;
  std::vector<NodeSums> sums_;
  std::vector<std::uint8_t> kept_;
};

}  // namespace

std::vector<std::uint8_t> lanes_that_pay(const accel::Bvh4& bvh, const cull::ObjectMasks& masks,
                                         const cull::MaskTester& tester, const RaySample& sample,
                                         const VisitCosts& costs, int threads) {
  const Chunks chunks = ask_everywhere(bvh, masks, tester, sample, threads);
  return Scales(bvh, masks, costs, chunks).judge();
}

}  // namespace ctu::sim
