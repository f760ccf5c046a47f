// A share of `ctusim check --packets`: what packet culling says of a packet holds for each of its rays.
#include "sim/check/packets/packet_campaign.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/intersect/ray.h"
#include "tests/oracle/seed.h"

namespace ctu::sim::check {
namespace {

PacketCampaignOptions options(std::uint64_t packets) {
  PacketCampaignOptions options;
  options.seed = oracle::test_seed();
  for (std::uint32_t i = 0; i < packet_generators().size(); ++i) options.generators.push_back(i);
  options.budget.cases = packets;
  return options;
}

TEST(PacketCampaign, what_a_method_says_of_a_packet_holds_for_every_ray) {
  SCOPED_TRACE(oracle::seed_note());
  const PacketCampaignOptions all = options(12000);
  const PacketCampaignResult result = run_packet_campaign(all);
  for (const PacketFailure& failure : result.failures)
    ADD_FAILURE() << failure.what << "\n  ctusim check --packets --seed " << oracle::test_seed() << " --generator "
                  << packet_generators()[failure.generator].name << " --scene " << failure.number;
  EXPECT_EQ(result.wrong(), 0u);

  // ... and something is said: every kind of packet has primitives that all its rays miss, and some are found.
  for (std::size_t g = 0; g < all.generators.size(); ++g)
    for (std::size_t kind = 0; kind < kPacketPrimitives.size(); ++kind) {
      SCOPED_TRACE(std::string(packet_generators()[g].name) + ", " + std::string(kPacketPrimitives[kind]));
      const PacketTally& tally = result.by_generator[g][kind];
      EXPECT_GT(tally.all_miss, tally.packets / 20);
      EXPECT_LT(tally.all_miss, tally.packets);
      std::uint64_t found = 0;
      for (const PacketAnswers& answers : tally.by_method) found = std::max(found, answers.all_miss);
      EXPECT_GT(found, tally.all_miss / 20);
      if (kPacketPrimitives[kind] == "box") {
        EXPECT_GT(tally.by_method[kUnitMethod].all_miss, 0u);
      }
    }
}

TEST(PacketCampaign, cases_are_valid_packets_of_4_to_64_rays) {
  SCOPED_TRACE(oracle::seed_note());
  for (std::uint32_t generator = 0; generator < packet_generators().size(); ++generator)
    for (std::uint64_t number = 0; number < 100; ++number) {
      const PacketCase packet = make_packet_case(oracle::test_seed(), generator, number);
      ASSERT_GE(packet.rays.size(), 4u);
      ASSERT_LE(packet.rays.size(), 64u);
      ASSERT_EQ(packet.rays.size(), packet.limits.size());
      for (std::size_t i = 0; i < packet.rays.size(); ++i) {
        ASSERT_TRUE(intersect::is_valid(packet.rays[i])) << packet_generators()[generator].name << " " << number;
        ASSERT_TRUE(packet.rays[i].tmin <= packet.limits[i] && packet.limits[i] <= packet.rays[i].tmax);
      }
      for (int axis = 0; axis < 3; ++axis) ASSERT_LE(packet.box.lo[axis], packet.box.hi[axis]);
    }
}

TEST(PacketCampaign, counts_do_not_depend_on_the_number_of_threads) {
  SCOPED_TRACE(oracle::seed_note());
  PacketCampaignOptions few = options(1);
  few.generators = {1};
  const PacketCampaignResult one = run_packet_campaign(few);
  few.threads = 3;
  const PacketCampaignResult three = run_packet_campaign(few);
  for (std::size_t kind = 0; kind < kPacketPrimitives.size(); ++kind) {
    const PacketTally &a = one.by_generator[0][kind], &b = three.by_generator[0][kind];
    EXPECT_EQ(a.rays, b.rays);
    EXPECT_EQ(a.all_miss, b.all_miss);
    for (std::size_t m = 0; m < a.by_method.size(); ++m) EXPECT_EQ(a.by_method[m].all_miss, b.by_method[m].all_miss);
  }
}

}  // namespace
}  // namespace ctu::sim::check
