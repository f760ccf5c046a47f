// Fronts and volumes against plain counting, and the search against what is known of its space.
#include "sim/sweep/pareto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <fmt/format.h>

#include "sim/sweep/nsga2.h"

namespace {

using namespace ctu::sweep;

std::uint64_t fresh_seed() {
  const std::uint64_t seed = std::random_device()();
  fmt::print("seed {}\n", seed);
  return seed;
}

std::vector<Objectives> random_points(std::mt19937& random, std::size_t count, std::size_t objectives, int most) {
  std::vector<Objectives> points(count, Objectives(objectives));
  for (Objectives& point : points)
    for (double& value : point) value = static_cast<double>(random() % static_cast<unsigned>(most + 1));
  return points;
}

/// Unit cubes of [0, most]^d that lie between a point and the reference, counted one by one.
double counted_volume(const std::vector<Objectives>& points, std::size_t objectives, int most) {
  double count = 0;
  std::vector<int> cell(objectives, 0);
  for (;;) {
    for (const Objectives& point : points) {
      bool inside = true;
      for (std::size_t i = 0; i < objectives; ++i) inside &= point[i] <= cell[i];
      if (inside) {
        ++count;
        break;
      }
    }
    std::size_t i = 0;
    while (i < objectives && ++cell[i] == most) cell[i++] = 0;
    if (i == objectives) return count;
  }
}

TEST(Pareto, the_hypervolume_is_the_number_of_unit_cubes_in_it) {
  std::mt19937 random(fresh_seed());
  for (int round = 0; round < 60; ++round) {
    const std::size_t objectives = 1 + random() % 4;
    const int most = 7;
    const auto points = random_points(random, random() % 9, objectives, most);
    EXPECT_DOUBLE_EQ(hypervolume(points, Objectives(objectives, most)), counted_volume(points, objectives, most));
  }
}

TEST(Pareto, nothing_dominates_the_front_and_the_front_dominates_the_rest) {
  std::mt19937 random(fresh_seed());
  for (int round = 0; round < 60; ++round) {
    const auto points = random_points(random, 1 + random() % 40, 2 + random() % 2, 9);
    const auto front = pareto_front(points);
    const auto numbers = front_numbers(points);
    std::vector<bool> on_front(points.size(), false);
    for (const std::size_t i : front) on_front[i] = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool dominated = false, repeated = false;
      for (std::size_t j = 0; j < points.size(); ++j) {
        dominated |= dominates(points[j], points[i]);
        repeated |= j < i && points[j] == points[i];
        if (dominates(points[j], points[i])) {
          EXPECT_LT(numbers[j], numbers[i]);
        }
      }
      EXPECT_EQ(on_front[i], !dominated && !repeated);
      EXPECT_EQ(numbers[i] == 0, !dominated);
    }
  }
}

TEST(Pareto, the_ends_of_a_front_are_the_loneliest_and_a_cluster_the_least) {
  const std::vector<Objectives> front = {{0, 10}, {5, 5}, {5.1, 4.9}, {5.2, 4.8}, {10, 0}};
  const auto distances = crowding_distances(front);
  EXPECT_TRUE(std::isinf(distances[0]) && std::isinf(distances[4]));
  EXPECT_LT(distances[2], distances[1]);
  EXPECT_LT(distances[2], distances[3]);
  EXPECT_NEAR(distances[2], 2 * 0.2 / 10, 1e-12);
}

/// Eight axes of eight choices: the first sets the trade, the others only cost (ZDT1 of Zitzler, Deb, Thiele 2000).
Objectives trade(const Candidate& c) {
  double rest = 0;
  for (std::size_t i = 1; i < c.size(); ++i) rest += c[i] / 7.0;
  const double x = c[0] / 7.0, g = 1 + 9 * rest / static_cast<double>(c.size() - 1);
  return {x, g * (1 - std::sqrt(x / g))};
}

std::vector<Objectives> searched(std::uint64_t seed, std::vector<Candidate>* asked = nullptr) {
  const CandidateSpace space(std::vector<std::uint32_t>(8, 8));
  Nsga2 search(space, 16, seed, [](const Candidate&) { return true; });
  std::vector<Objectives> all;
  for (int generation = 0; generation < 20; ++generation) {
    std::vector<Judged> judged;
    for (const Candidate& candidate : search.ask()) {
      judged.push_back({candidate, trade(candidate)});
      all.push_back(trade(candidate));
      if (asked != nullptr) asked->push_back(candidate);
    }
    search.tell(judged);
  }
  return all;
}

TEST(Nsga2, covers_more_than_as_many_random_candidates) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto guided = searched(seed);
    std::vector<Objectives> random;
    for (const Candidate& c : draw_candidates(CandidateSpace(std::vector<std::uint32_t>(8, 8)), guided.size(), seed, 3,
                                              [](const Candidate&) { return true; }))
      random.push_back(trade(c));
    EXPECT_EQ(guided.size(), 16u * 20);
    EXPECT_GT(hypervolume(guided, {1.1, 10}), hypervolume(random, {1.1, 10})) << seed;
  }
}

TEST(Nsga2, never_asks_twice_and_asks_the_same_for_the_same_answers) {
  std::vector<Candidate> once, again, other;
  searched(5, &once);
  searched(5, &again);
  searched(6, &other);
  EXPECT_EQ(once, again);
  EXPECT_NE(once, other);
  EXPECT_EQ(std::set<Candidate>(once.begin(), once.end()).size(), once.size());
}

TEST(Nsga2, asks_only_what_is_accepted_and_ends_when_all_was_asked) {
  const CandidateSpace space(std::vector<std::uint32_t>{3, 4, 5});
  const Accept accept = [](const Candidate& c) { return c[0] != 1; };
  Nsga2 search(space, 8, 2, accept);
  std::set<Candidate> seen;
  for (int generation = 0; generation < 30; ++generation) {
    std::vector<Judged> judged;
    for (const Candidate& candidate : search.ask()) {
      EXPECT_TRUE(accept(candidate));
      EXPECT_TRUE(seen.insert(candidate).second);
      std::optional<Objectives> objectives;  // a third of them fail
      if (candidate[1] != 0) objectives = Objectives{double(candidate[1]), double(candidate[2])};
      judged.push_back({candidate, objectives});
    }
    search.tell(judged);
  }
  EXPECT_LE(seen.size(), 40u);
  EXPECT_GE(seen.size(), 30u);
}

}  // namespace
