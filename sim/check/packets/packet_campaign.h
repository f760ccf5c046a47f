// `ctusim check --packets`: random packets by the million, every answer of every packet culling method held against the
// exact answer of each ray.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/cull/packet/method.h"
#include "sim/check/campaign.h"
#include "sim/check/packets/packet_case.h"

namespace ctu::sim::check {

inline constexpr std::array<std::string_view, 4> kPacketPrimitives = {"box", "triangle", "sphere", "moving"};

/// The methods that are judged: those of cull::packet, and the slab test of the unit's packet_cull, for boxes only.
inline constexpr std::size_t kJudgedMethods = cull::packet::kMethods.size() + 1;
inline constexpr std::size_t kUnitMethod = kJudgedMethods - 1;
std::string_view judged_method_name(std::size_t method);

/// What one method says of one kind of primitive.
struct PacketAnswers {
  std::uint64_t all_miss = 0, all_hit = 0;
  std::uint64_t lost = 0;      ///< of `all_miss`: some ray meets the primitive exactly
  std::uint64_t invented = 0;  ///< of `all_hit`: some ray does not
};

struct PacketTally {
  std::uint64_t packets = 0, rays = 0;
  std::uint64_t all_miss = 0, all_hit = 0;  ///< in exact arithmetic
  std::array<PacketAnswers, kJudgedMethods> by_method;

  std::uint64_t wrong() const;
  PacketTally& operator+=(const PacketTally& other);
};

using PacketTallies = std::array<PacketTally, kPacketPrimitives.size()>;

/// A wrong answer, with every bit of the case.
struct PacketFailure {
  std::uint32_t generator = 0;
  std::uint64_t number = 0;
  std::string what;
};

/// Judges one case; failures are appended, at most `kept` in all.
void judge_packet(std::uint64_t seed, std::uint32_t generator, std::uint64_t number, PacketTallies& tallies,
                  std::vector<PacketFailure>& failures, std::size_t kept);

struct PacketCampaignOptions {
  std::uint64_t seed = 1;
  std::vector<std::uint32_t> generators;   ///< places in packet_generators()
  std::optional<std::uint64_t> only_case;  ///< of each generator; the budget plays no part
  Budget budget;                           ///< cases are packets, shared among the generators
  int threads = 1;
  std::size_t kept_failures = 16;
};

struct PacketCampaignResult {
  std::vector<PacketTallies> by_generator;  ///< as PacketCampaignOptions::generators
  std::vector<PacketFailure> failures;      ///< the first ones
  double seconds = 0;
  std::uint64_t wrong() const;
};

/// The same counts for any number of threads. `progress` is called with packets so far.
PacketCampaignResult run_packet_campaign(const PacketCampaignOptions& options,
                                         const std::function<void(std::uint64_t packets)>& progress = {});

void print_packet_campaign(const PacketCampaignOptions& options, const PacketCampaignResult& result);

}  // namespace ctu::sim::check
