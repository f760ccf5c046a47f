// A configuration of a space before it is resolved: which trace group, and which choice of every axis. What a search
// draws, crosses and moves.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/sweep/space.h"

namespace ctu::sweep {

/// The trace group, then a choice of each axis.
using Candidate = std::vector<std::uint32_t>;

class CandidateSpace {
 public:
  explicit CandidateSpace(const Space& space);
  /// Of so many choices each: for searches by themselves.
  explicit CandidateSpace(std::vector<std::uint32_t> sizes) : sizes_(std::move(sizes)) {}

  const std::vector<std::uint32_t>& sizes() const { return sizes_; }
  /// How many candidates there are; the largest number there is when they are more.
  std::uint64_t count() const;
  /// Candidate `number` < count(); the last axis moves fastest.
  Candidate at(std::uint64_t number) const;

 private:
  std::vector<std::uint32_t> sizes_;
};

using Accept = std::function<bool(const Candidate&)>;

/// Up to `count` different candidates that `accept` takes, uniformly drawn: Philox with this seed and stream, the same
/// on every machine. Fewer when the space has no more, or when hardly any is accepted.
std::vector<Candidate> draw_candidates(const CandidateSpace& space, std::uint64_t count, std::uint64_t seed,
                                       std::uint32_t stream, const Accept& accept);

}  // namespace ctu::sweep
