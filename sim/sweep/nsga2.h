// NSGA-II over choices (Deb, Pratap, Agarwal, Meyarivan 2002): a population of candidates, better and more spread out
// with each generation. Everything it draws comes from Philox by seed, generation and child, so that the same answers
// lead to the same questions: a search that was interrupted is repeated from its beginning, and what was run is known.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "sim/sweep/candidate.h"
#include "sim/sweep/pareto.h"

namespace ctu::sweep {

struct Judged {
  Candidate candidate;
  std::optional<Objectives> objectives;  ///< nothing: it has no result
};

class Nsga2 {
 public:
  /// A population of `population` candidates that `accept` takes.
  Nsga2(const CandidateSpace& space, std::uint32_t population, std::uint64_t seed, Accept accept);

  /// What is to be judged next: the first population, then children of the best so far, all of them new. Empty when
  /// nothing new is found.
  std::vector<Candidate> ask();
  /// The answers, in the order of the questions.
  void tell(const std::vector<Judged>& judged);

 private:
  struct Member {
    Judged judged;
    int front = 0;
    double crowding = 0;
  };
  Candidate child(std::uint64_t number) const;
  void rank(std::vector<Member>& members) const;

  CandidateSpace space_;
  std::uint32_t population_;
  std::uint64_t seed_;
  Accept accept_;
  std::uint64_t asked_ = 0;  ///< children drawn so far
  std::vector<Member> parents_;
  std::set<Candidate> seen_;
};

}  // namespace ctu::sweep
