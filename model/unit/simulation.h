// A SystemC simulation with its own kernel context, so that one process can run many, one after the other.
#pragma once

#include <systemc>

namespace ctu::unit {

/// SystemC elaborates once per context; a new one is put in place here and taken away at the end. Everything built in
/// it must be gone before. Not for two threads at a time.
class Simulation {
 public:
  Simulation();
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

 private:
  sc_core::sc_simcontext* previous_;
  sc_core::sc_simcontext* previous_default_;
};

}  // namespace ctu::unit
