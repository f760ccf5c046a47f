#include "sim/check/recorded_rays.h"

#include <fmt/format.h>

namespace ctu::sim::check {

std::shared_ptr<const reference::RayBlock> record_rays(const CheckScene& scene) {
  const reference::Traversal traversal = scene.traversal();
  auto block = std::make_shared<reference::RayBlock>();
  block->rays = scene.hard.rays;
  if (scene.setup.packets.any()) {
    const reference::PacketWalk walk = scene.packet_walk();
    block->expected = walk.trace(traversal, block->steps);
    block->packets = walk.list();
    return block;
  }
  for (const intersect::Ray& ray : block->rays) block->expected.push_back(traversal.trace(ray, &block->steps));
  return block;
}

Answers answers_of(const pipeline::UnitResult& result, const reference::RayBlock& recorded) {
  Answers answers;
  answers.hits = recorded.expected;
  for (const pipeline::WrongHit& wrong : result.first_wrong) {
    answers.hits[wrong.ray] = wrong.returned;
    answers.differences.push_back({static_cast<std::uint32_t>(wrong.ray),
                                   fmt::format("the unit answers primitive {} at {:a}, the reference {} at {:a}",
                                               static_cast<std::int32_t>(wrong.returned.primitive), wrong.returned.t,
                                               static_cast<std::int32_t>(wrong.expected.primitive), wrong.expected.t)});
  }
  answers.other_differences = result.wrong_hits - result.first_wrong.size() + result.other_visits;
  return answers;
}

}  // namespace ctu::sim::check
