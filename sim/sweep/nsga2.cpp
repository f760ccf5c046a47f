#include "sim/sweep/nsga2.h"

#include <algorithm>
#include <limits>
#include <map>

#include "model/scene/random.h"

namespace ctu::sweep {
namespace {

// Streams of the random numbers; a comparison by random draws has a stream of its own.
constexpr std::uint32_t kFirst = 1, kChildren = 2;

std::uint32_t below(scene::Random& random, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::uint64_t{random.bits()} * count >> 32);
}

/// The lower front first, within a front the more lonely.
template <class Member>
bool is_better(const Member& a, const Member& b) {
  return a.front != b.front ? a.front < b.front : a.crowding > b.crowding;
}

/// A step to a neighbouring choice, for axes are in order as a rule, or a jump to any.
void mutate(Candidate& candidate, const std::vector<std::uint32_t>& sizes, scene::Random& random) {
  const auto genes = static_cast<std::uint32_t>(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] < 2 || below(random, genes) != 0) continue;
    if (below(random, 2) == 0) {
      candidate[i] = below(random, sizes[i]);
    } else if (below(random, 2) == 0) {
      candidate[i] = std::min(candidate[i] + 1, sizes[i] - 1);
    } else if (candidate[i] > 0) {
      --candidate[i];
    }
  }
}

}  // namespace

Nsga2::Nsga2(const CandidateSpace& space, std::uint32_t population, std::uint64_t seed, Accept accept)
    : space_(space), population_(population), seed_(seed), accept_(std::move(accept)) {}

Candidate Nsga2::child(std::uint64_t number) const {
  scene::Random random(seed_, number, kChildren);
  const auto parent = [&]() -> const Candidate& {
    const auto count = static_cast<std::uint32_t>(parents_.size());
    const Member &a = parents_[below(random, count)], &b = parents_[below(random, count)];
    return (is_better(b, a) ? b : a).judged.candidate;
  };
  Candidate child = parent();
  const Candidate& other = parent();
  for (std::size_t i = 0; i < child.size(); ++i)
    if (below(random, 2) == 0) child[i] = other[i];
  mutate(child, space_.sizes(), random);
  return child;
}

std::vector<Candidate> Nsga2::ask() {
  constexpr std::uint64_t kTriesEach = 200;
  std::vector<Candidate> questions;
  if (parents_.empty()) {
    questions = draw_candidates(space_, population_, seed_, kFirst, accept_);
    seen_.insert(questions.begin(), questions.end());
    return questions;
  }
  for (std::uint64_t tries = 0; tries < population_ * kTriesEach && questions.size() < population_; ++tries) {
    Candidate next = child(asked_++);
    if (accept_(next) && seen_.insert(next).second) questions.push_back(std::move(next));
  }
  return questions;
}

void Nsga2::rank(std::vector<Member>& members) const {
  std::vector<std::size_t> with_result;
  std::vector<Objectives> points;
  for (std::size_t i = 0; i < members.size(); ++i) {
    members[i].front = std::numeric_limits<int>::max();  // what has no result comes behind all that have
    members[i].crowding = 0;
    if (!members[i].judged.objectives) continue;
    with_result.push_back(i);
    points.push_back(*members[i].judged.objectives);
  }
  const std::vector<int> numbers = front_numbers(points);
  std::map<int, std::vector<std::size_t>> fronts;
  for (std::size_t i = 0; i < points.size(); ++i) fronts[numbers[i]].push_back(i);
  for (const auto& [number, places] : fronts) {
    std::vector<Objectives> front;
    for (const std::size_t place : places) front.push_back(points[place]);
    const std::vector<double> distances = crowding_distances(front);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Member& member = members[with_result[places[i]]];
      member.front = number;
      member.crowding = distances[i];
    }
  }
}

void Nsga2::tell(const std::vector<Judged>& judged) {
  for (const Judged& one : judged) parents_.push_back({one, 0, 0});
  rank(parents_);
  std::stable_sort(parents_.begin(), parents_.end(), is_better<Member>);
  if (parents_.size() > population_) parents_.resize(population_);
}

}  // namespace ctu::sweep
