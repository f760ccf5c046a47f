// From candidates of a space to the points that are run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/sweep/candidate.h"
#include "sim/sweep/point.h"

namespace ctu::sweep {

class Expander {
 public:
  explicit Expander(const Space& space) : space_(space) {}

  /// What the axes and the trace group set.
  Settings settings(const Candidate& candidate) const;
  /// The configuration; nothing, and a reason, when rules between parameters forbid it.
  std::optional<pipeline::UnitConfig> config(const Candidate& candidate, std::string* why = nullptr) const;
  /// Traces of the candidate's group that no [[exclude]] takes out.
  std::vector<std::size_t> traces(const Candidate& candidate) const;
  /// Whether there is anything to run.
  bool accepts(const Candidate& candidate) const;

  /// A point for each trace that is not excluded; `facts` of every trace of the space.
  std::vector<Point> points(const Candidate& candidate, const std::vector<TraceFacts>& facts) const;

 private:
  const Space& space_;
};

/// How much of a grid is left to run, and why the rest is not.
struct GridCount {
  std::uint64_t candidates = 0, excluded = 0, refused = 0;
  std::string first_refusal;
  std::vector<Candidate> accepted;
};
/// Throws Error when the grid has more than ten million candidates.
GridCount walk_grid(const Space& space);

}  // namespace ctu::sweep
