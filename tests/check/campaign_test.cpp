// The campaign of hard cases, itself checked: it counts alike on any number of threads, finds what is planted, and what
// it finds can be replayed.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/numeric/round.h"
#include "sim/check/campaign.h"
#include "sim/check/failure_files.h"
#include "sim/check/judge.h"

#include "sim/loaded_trace.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"
#include "tests/sim/program.h"

namespace ctu::sim::check {
namespace {

using intersect::Hit;
using intersect::Ray;

std::vector<std::uint32_t> all_generators() {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < generators().size(); ++i) all.push_back(i);
  return all;
}

DrawSetup draw_from(const SetupChoice& choice) {
  return [choice](CaseRandom& random) { return draw_setup(choice, random); };
}

CampaignOptions small_campaign() {
  CampaignOptions options;
  options.seed = oracle::test_seed();
  options.generators = all_generators();
  options.draw_setup = draw_from({.designs = all_designs()});
  options.make_execution = make_reference_execution;
  options.budget = parse_budget("20000");
  return options;
}

/// The reference, but for rays whose number `wrong` picks: these miss everything.
class ForgetfulExecution : public Execution {
 public:
  Answers run(const CheckScene& scene, CaseRandom& random) override {
    Answers answers = make_reference_execution()->run(scene, random);
    for (std::size_t i = 0; i < answers.hits.size(); i += 16) {
      answers.hits[i] = {};
      answers.hits[i].t = scene.hard.rays[i].tmax;
    }
    return answers;
  }
};

TEST(Campaign, counts_alike_on_any_number_of_threads) {
  SCOPED_TRACE(oracle::seed_note());
  CampaignOptions options = small_campaign();
  const Tally one = run_campaign(options).total();
  options.threads = 3;
  const Tally three = run_campaign(options).total();
  EXPECT_GE(one.rays, 20000u);
  EXPECT_EQ(one.lost, 0u);
  EXPECT_FALSE(one.failed());
  EXPECT_EQ(one.exact_hits, one.kept + one.lost + one.declined + one.misplaced);
  EXPECT_EQ(one.rays, three.rays);
  EXPECT_EQ(one.exact_hits, three.exact_hits);
  EXPECT_EQ(one.kept, three.kept);
  EXPECT_EQ(one.near_misses, three.near_misses);
  EXPECT_EQ(one.cells_marked, three.cells_marked);
  EXPECT_EQ(one.oracle.asked, three.oracle.asked);
}

TEST(Campaign, finds_hits_that_an_execution_forgets) {
  SCOPED_TRACE(oracle::seed_note());
  CampaignOptions options = small_campaign();
  options.make_execution = [] { return std::make_unique<ForgetfulExecution>(); };
  const CampaignResult result = run_campaign(options);
  EXPECT_GT(result.total().lost, 100u);
  ASSERT_EQ(result.failures.size(), options.kept_failures);
  for (const Failure& failure : result.failures) EXPECT_EQ(failure.ray % 16, 0u);
}

TEST(Campaign, a_scene_is_remade_from_its_numbers) {
  CampaignOptions options = small_campaign();
  options.generators = {3};
  options.only_scene = 5;
  const Tally alone = run_campaign(options).total();
  EXPECT_EQ(alone.scenes, 1u);
  options.only_scene.reset();
  std::uint64_t rays = 0;
  for (std::uint64_t scene = 0; scene < 6; ++scene) rays += make_case(options.seed, 3, scene).rays.size();
  options.budget.cases = rays;
  const Tally six = run_campaign(options).total();
  options.budget.cases = rays - make_case(options.seed, 3, 5).rays.size();
  const Tally five = run_campaign(options).total();
  EXPECT_EQ(six.exact_hits - five.exact_hits, alone.exact_hits);
  EXPECT_EQ(six.near_misses - five.near_misses, alone.near_misses);
  EXPECT_EQ(six.oracle.asked - five.oracle.asked, alone.oracle.asked);
}

TEST(Campaign, brute_force_skips_no_triangle_that_is_met) {
  SCOPED_TRACE(oracle::seed_note());
  const std::uint64_t seed = oracle::test_seed();
  TesterCache testers;
  int exact = 0;
  for (const std::uint32_t generator : all_generators()) {
    CaseRandom random = scene_random(seed, {generator, 0});
    const DrawSetup draw = draw_from({.designs = {cull::Design::None}});
    const CheckScene scene = make_scene(seed, {generator, 0}, draw, random, testers);
    if (scene.bvh.triangles.size() > 500) continue;
    BruteForce brute_force(scene.bvh);
    for (std::size_t i = 0; i < scene.hard.rays.size(); i += 12) {
      const Ray& ray = scene.hard.rays[i];
      std::vector<bool> found(scene.bvh.triangles.size());
      for (const Meeting& m : brute_force.meetings(intersect::prepare_ray(ray))) found[m.triangle] = m.exact;
      for (std::uint32_t t = 0; t < scene.bvh.triangles.size(); ++t) {
        const accel::LeafTriangle& triangle = scene.bvh.triangles[t];
        const bool is_met =
            oracle::exact_ray_triangle(ray, triangle.v0, triangle.v1, triangle.v2, ray.tmin, ray.tmax).hit;
        const bool is_found = found[t];
        ASSERT_EQ(is_met, is_found) << generators()[generator].name << " ray " << i << " triangle " << t;
        exact += is_met;
      }
    }
  }
  EXPECT_GT(exact, 300);
}

TEST(Campaign, every_kind_of_scene_goes_through_a_trace) {
  SCOPED_TRACE(oracle::seed_note());
  const std::uint64_t seed = oracle::test_seed();
  const test::ScratchFolder folder;
  const std::string path = folder.path() / "case.ctut";
  TesterCache testers;
  for (const std::uint32_t generator : all_generators()) {
    const SceneNumber number{generator, 1};
    CaseRandom random = scene_random(seed, number);
    const CheckScene scene = make_scene(seed, number, draw_from({.designs = all_designs()}), random, testers);
    const auto ray = static_cast<std::uint32_t>(scene.hard.rays.size() / 2);
    write_one_ray_trace(scene, ray, seed, path);
    const LoadedTrace trace(path);
    trace.reader().verify();
    ASSERT_EQ(trace.reader().rays(), 1u);
    const reference::RayBlock block = trace.reader().read_block(0, std::nullopt);
    EXPECT_TRUE(same_bits(block.expected[0], Judge(scene).true_hit(scene.hard.rays[ray])));
    EXPECT_EQ(ctu::numeric::bits(block.rays[0].origin.x), ctu::numeric::bits(scene.hard.rays[ray].origin.x));
    EXPECT_EQ(ctu::numeric::bits(block.rays[0].direction.z), ctu::numeric::bits(scene.hard.rays[ray].direction.z));
    EXPECT_EQ(trace.bvh().nodes.size(), scene.bvh.nodes.size()) << generators()[generator].name;
    trace.tester(scene.setup.design);
  }
}

TEST(Campaign, a_failing_case_is_replayed_by_the_command_beside_it) {
  SCOPED_TRACE(oracle::seed_note());
  const std::uint64_t seed = oracle::test_seed();
  const test::ScratchFolder folder;
  TesterCache testers;
  int replayed = 0;
  for (std::uint32_t generator = 0; generator < generators().size(); generator += 4) {
    const SceneNumber number{generator, 2};
    CaseRandom random = scene_random(seed, number);
    const SetupChoice choice{.designs = {cull::Design::MaskLut, cull::Design::Comparators}};
    const CheckScene scene = make_scene(seed, number, draw_from(choice), random, testers);
    const Answers answers = make_reference_execution()->run(scene, random);
    Judge judge(scene);
    std::uint32_t ray = 0;  // one that hits what it should, so that the replay must agree
    while (ray < answers.hits.size() && (answers.hits[ray].primitive == intersect::kNoPrimitive ||
                                         !same_bits(answers.hits[ray], judge.true_hit(scene.hard.rays[ray]))))
      ++ray;
    if (ray == answers.hits.size()) continue;
    const std::string path = folder.path() / "case.ctut";
    write_one_ray_trace(scene, ray, seed, path);
    const std::string engine = generator % 8 == 0 ? "reference" : "cycle";
    const std::string command = replay_command(scene.setup, engine, path);
    const test::Outcome outcome = test::run_program(folder.path(), command.substr(command.find(' ') + 1));
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.out << outcome.err;
    ++replayed;
  }
  EXPECT_GT(replayed, 5);
}

TEST(CheckCommand, reports_what_it_counted) {
  const test::ScratchFolder folder;
  const test::Outcome outcome =
      test::run_program(folder.path(),
                        "check --seed 77 --budget 3000 --generator through-vertices,hair --design comparators --r 6 "
                        "--failures failures --json result.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("seed 77"), std::string::npos);
  EXPECT_NE(outcome.out.find("hits lost: 0"), std::string::npos) << outcome.out;
  const auto result = nlohmann::json::parse(test::read_text(folder.path() / "result.json"));
  EXPECT_EQ(result["seed"], 77);
  EXPECT_EQ(result["hits_lost"], 0);
  EXPECT_GE(result["cases"].get<int>(), 3000);
  ASSERT_EQ(result["generators"].size(), 2u);
  EXPECT_EQ(result["generators"][1]["generator"], "hair");
  EXPECT_EQ(result["cases"], result["generators"][0]["cases"].get<int>() + result["generators"][1]["cases"].get<int>());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "failures")) << "nothing failed";
}

TEST(CheckCommand, a_fresh_seed_is_printed_and_repeats_the_run) {
  const test::ScratchFolder folder;
  const auto counts_of = [](const std::string& out) { return out.substr(out.find("\ntotal"), 80); };
  const test::Outcome first = test::run_program(folder.path(), "check --budget 2000 --generator soup --threads 1");
  ASSERT_EQ(first.exit_code, 0) << first.out << first.err;
  const std::string seed = first.out.substr(5, first.out.find('\n') - 5);
  const test::Outcome again =
      test::run_program(folder.path(), "check --budget 2000 --generator soup --threads 2 --seed " + seed);
  EXPECT_EQ(counts_of(first.out), counts_of(again.out));
}

TEST(CheckCommand, refuses_what_is_not_there) {
  const test::ScratchFolder folder;
  for (const char* arguments :
       {"--generator sope", "--design maskless", "--engine gates", "--budget never", "--r 9", "--r 4 --r-ray 3",
        "--l 6", "--engine cycle --design ideal", "--json /nowhere/at/all.json", "--scene -1"}) {
    const test::Outcome outcome = test::run_program(folder.path(), std::string("check --seed 1 ") + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out << outcome.err;
  }
}

TEST(Campaign, budgets_are_cases_or_times) {
  EXPECT_EQ(parse_budget("1000000").cases, 1000000u);
  EXPECT_EQ(parse_budget("1e9").cases, 1000000000u);
  EXPECT_EQ(parse_budget("90s").seconds, 90);
  EXPECT_EQ(parse_budget("1.5m").seconds, 90);
  for (const char* text : {"", "0", "-5", "ten", "5h", "1e30", "nan", "inf s", "s"})
    EXPECT_THROW(parse_budget(text), Error) << text;
}

}  // namespace
}  // namespace ctu::sim::check
