// The timed unit under hard cases: in SystemC, and in gates. Each answer is compared with the reference's, bit for bit.
#pragma once

#include <memory>

#include "sim/check/execution.h"

namespace ctu::sim::check {

/// The SystemC unit with stages that compute, in batch, cycle and pins mode, with timing drawn for each scene. One
/// SystemC kernel serves all threads, one after the other.
std::unique_ptr<Execution> make_cycle_execution();

/// The Verilated unit, of the builds at hand. Throws Error when there is none.
std::unique_ptr<Execution> make_rtl_execution();

/// Draws a design and masks that a build at hand has. Throws Error when none has what is chosen.
DrawSetup draw_rtl_setup(const SetupChoice& choice);

}  // namespace ctu::sim::check
