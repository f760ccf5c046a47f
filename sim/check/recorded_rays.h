// A scene's rays with the reference's hits and visits, as a unit is given them, and what the unit made of them.
#pragma once

#include <memory>
#include <utility>

#include "model/pipeline/result.h"
#include "model/reference/ray_block.h"
#include "sim/check/execution.h"

namespace ctu::sim::check {

/// Rays, hits and steps of the scene's own design; where rays travel in packets, from their entries on.
std::shared_ptr<const reference::RayBlock> record_rays(const CheckScene& scene);

/// One block, once.
class OneBlockFeed : public reference::RayFeed {
 public:
  explicit OneBlockFeed(std::shared_ptr<const reference::RayBlock> block, const reference::PacketPlan& packets = {})
      : block_(std::move(block)), packets_(packets) {}
  std::shared_ptr<const reference::RayBlock> next() override { return std::exchange(block_, nullptr); }
  std::uint64_t total_rays() const override { return block_ ? block_->rays.size() : 0; }

  reference::PacketPlan packets() const override { return packets_; }

 private:
  std::shared_ptr<const reference::RayBlock> block_;
  reference::PacketPlan packets_;
};

/// The recorded hits but for those that the unit answered otherwise.
Answers answers_of(const pipeline::UnitResult& result, const reference::RayBlock& recorded);

}  // namespace ctu::sim::check
