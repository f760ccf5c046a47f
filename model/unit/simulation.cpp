#include "model/unit/simulation.h"

#include <cstdlib>

// The library's own main, which we do not use, wants it.
int sc_main(int, char**) { return 0; }

namespace ctu::unit {

Simulation::Simulation()
    : previous_(sc_core::sc_curr_simcontext), previous_default_(sc_core::sc_default_global_context) {
  // Results go to standard output; the kernel's banner must not.
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
  sc_core::sc_curr_simcontext = sc_core::sc_default_global_context = new sc_core::sc_simcontext;
}

Simulation::~Simulation() {
  delete sc_core::sc_curr_simcontext;
  sc_core::sc_curr_simcontext = previous_;
  sc_core::sc_default_global_context = previous_default_;
}

}  // namespace ctu::unit
