#include "sim/sweep/candidate.h"

#include <limits>
#include <set>

#include "model/scene/random.h"

namespace ctu::sweep {

CandidateSpace::CandidateSpace(const Space& space) {
  sizes_.push_back(static_cast<std::uint32_t>(space.groups.size()));
  for (const Axis& axis : space.axes) sizes_.push_back(static_cast<std::uint32_t>(axis.choices.size()));
}

std::uint64_t CandidateSpace::count() const {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t product = 1;
  for (const std::uint32_t size : sizes_) {
    if (size == 0) return 0;
    if (product > kMost / size) return kMost;
    product *= size;
  }
  return product;
}

Candidate CandidateSpace::at(std::uint64_t number) const {
  Candidate candidate(sizes_.size());
  for (std::size_t i = sizes_.size(); i-- > 0; number /= sizes_[i])
    candidate[i] = static_cast<std::uint32_t>(number % sizes_[i]);
  return candidate;
}

std::vector<Candidate> draw_candidates(const CandidateSpace& space, std::uint64_t count, std::uint64_t seed,
                                       std::uint32_t stream, const Accept& accept) {
  std::vector<Candidate> drawn;
  std::set<Candidate> seen;
  // A draw that meets what was seen, or what is not accepted, is repeated; a space of a few candidates is soon dry.
  constexpr std::uint64_t kTriesEach = 200;
  const std::uint64_t all = space.count();
  for (std::uint64_t item = 0; drawn.size() < count && seen.size() < all && item < count * kTriesEach; ++item) {
    scene::Random random(seed, item, stream);
    Candidate candidate;
    for (const std::uint32_t size : space.sizes())
      candidate.push_back(static_cast<std::uint32_t>(std::uint64_t{random.bits()} * size >> 32));
    if (seen.insert(candidate).second && accept(candidate)) drawn.push_back(std::move(candidate));
  }
  return drawn;
}

}  // namespace ctu::sweep
