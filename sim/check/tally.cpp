#include "sim/check/tally.h"

namespace ctu::sim::check {

Tally& Tally::operator+=(const Tally& other) {
  constexpr std::uint64_t Tally::*kCounts[] = {&Tally::scenes,        &Tally::rays,
                                               &Tally::exact_hits,    &Tally::kept,
                                               &Tally::lost,          &Tally::declined,
                                               &Tally::misplaced,     &Tally::near_misses,
                                               &Tally::ties,          &Tally::invented,
                                               &Tally::differences,   &Tally::failed_rays,
                                               &Tally::lanes,         &Tally::uncertain_lanes,
                                               &Tally::sampled_lanes, &Tally::cells_marked,
                                               &Tally::cells_exact,   &Tally::cells_over,
                                               &Tally::cells_lost};
  for (const auto count : kCounts) this->*count += other.*count;
  oracle += other.oracle;
  return *this;
}

}  // namespace ctu::sim::check
