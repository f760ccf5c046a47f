#include "sim/check/packets/packet_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "model/base/parallel.h"

namespace ctu::sim::check {
namespace {

constexpr std::uint64_t kPacketsPerRound = 512;  ///< of each generator
constexpr std::size_t kPacketsPerChunk = 64;

struct Part {
  PacketTallies tallies;
  std::vector<PacketFailure> failures;
};

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

void print_row(std::string_view generator, std::string_view primitive, const PacketTally& tally) {
  fmt::print("{:<16}{:<10}{:>9}{:>10}", generator, primitive, tally.packets, tally.all_miss);
  for (const PacketAnswers& answers : tally.by_method)
    fmt::print("{:>14.2f}", percent(answers.all_miss, tally.all_miss));
  fmt::print("{:>10}", tally.all_hit);
  for (const PacketAnswers& answers : tally.by_method) fmt::print("{:>14.2f}", percent(answers.all_hit, tally.all_hit));
  fmt::print("{:>7}\n", tally.wrong());
}

}  // namespace

std::string_view judged_method_name(std::size_t method) {
  return method == kUnitMethod ? "unit-slabs" : to_string(cull::packet::kMethods[method]);
}

std::uint64_t PacketTally::wrong() const {
  std::uint64_t sum = 0;
  for (const PacketAnswers& answers : by_method) sum += answers.lost + answers.invented;
  return sum;
}

PacketTally& PacketTally::operator+=(const PacketTally& other) {
  packets += other.packets;
  rays += other.rays;
  all_miss += other.all_miss;
  all_hit += other.all_hit;
  for (std::size_t i = 0; i < by_method.size(); ++i) {
    by_method[i].all_miss += other.by_method[i].all_miss;
    by_method[i].all_hit += other.by_method[i].all_hit;
    by_method[i].lost += other.by_method[i].lost;
    by_method[i].invented += other.by_method[i].invented;
  }
  return *this;
}

std::uint64_t PacketCampaignResult::wrong() const {
  std::uint64_t sum = 0;
  for (const PacketTallies& tallies : by_generator)
    for (const PacketTally& tally : tallies) sum += tally.wrong();
  return sum;
}

PacketCampaignResult run_packet_campaign(const PacketCampaignOptions& options,
                                         const std::function<void(std::uint64_t packets)>& progress) {
  const auto started = std::chrono::steady_clock::now();
  PacketCampaignResult result;
  result.by_generator.resize(options.generators.size());
  const std::uint64_t round = options.only_case ? 1 : kPacketsPerRound;
  for (std::uint64_t first = options.only_case.value_or(0), packets = 0;; first += round) {
    const std::size_t chunks = (round + kPacketsPerChunk - 1) / kPacketsPerChunk;
    std::vector<Part> parts(options.generators.size() * chunks);
    parallel_chunks(parts.size(), 1, options.threads, [&](std::size_t part, std::size_t) {
      const std::uint32_t generator = options.generators[part / chunks];
      const std::uint64_t from = part % chunks * kPacketsPerChunk, to = std::min(from + kPacketsPerChunk, round);
      for (std::uint64_t i = from; i < to; ++i)
        judge_packet(options.seed, generator, first + i, parts[part].tallies, parts[part].failures,
                     options.kept_failures);
    });
    for (std::size_t part = 0; part < parts.size(); ++part) {
      PacketTallies& tallies = result.by_generator[part / chunks];
      for (std::size_t i = 0; i < tallies.size(); ++i) tallies[i] += parts[part].tallies[i];
      for (PacketFailure& failure : parts[part].failures)
        if (result.failures.size() < options.kept_failures) result.failures.push_back(std::move(failure));
    }
    packets += round * options.generators.size();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (progress) progress(packets);
    const bool used_up =
        options.budget.cases != 0 ? packets >= options.budget.cases : result.seconds >= options.budget.seconds;
    if (options.only_case || used_up) return result;
  }
}

void print_packet_campaign(const PacketCampaignOptions& options, const PacketCampaignResult& result) {
  fmt::print("{:45}{:^84}{:10}{:^84}\n{:<16}{:<10}{:>9}{:>10}", "", "found, % of exact all-miss", "",
             "found, % of exact all-hit", "packets", "primitive", "number", "all-miss");
  const auto print_names = [] {
    for (std::size_t method = 0; method < kJudgedMethods; ++method) fmt::print("{:>14}", judged_method_name(method));
  };
  print_names();
  fmt::print("{:>10}", "all-hit");
  print_names();
  fmt::print("{:>7}\n", "wrong");
  std::uint64_t packets = 0, rays = 0;
  for (std::size_t g = 0; g < options.generators.size(); ++g) {
    const PacketTallies& tallies = result.by_generator[g];
    for (std::size_t i = 0; i < tallies.size(); ++i)
      print_row(packet_generators()[options.generators[g]].name, kPacketPrimitives[i], tallies[i]);
    packets += tallies[0].packets;
    rays += tallies[0].rays;
  }
  fmt::print(
      "seed {}: {} packets of {} rays, asked about 4 primitives each, in {:.1f} s on {} threads; wrong answers: {}\n",
      options.seed, packets, rays, result.seconds, options.threads, result.wrong());
}

}  // namespace ctu::sim::check
