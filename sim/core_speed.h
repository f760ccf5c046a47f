// How fast the processor's core is at the moment: on a shared machine it may be half of what it was a minute ago.
#pragma once

namespace ctu::sim {

/// Additions that depend on each other, in a nanosecond of wall time, over about 5 ms: the clock frequency in GHz of a
/// core that nobody shares, since every processor of today takes a cycle for each.
double core_speed();

}  // namespace ctu::sim
