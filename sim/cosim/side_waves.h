// The waveform of one side of a co-simulation. Both sides' have the same signals under the same names, so that a viewer
// lays one over the other.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/pipeline/wave_writer.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

class SideWaves {
 public:
  /// Links and stages by their names; writes cycles [first, last]. Throws Error when the file cannot be written.
  SideWaves(const std::string& path, const std::vector<std::string>& links, const std::vector<std::string>& stages,
            pipeline::Cycle first, pipeline::Cycle last);

  /// What a link, or a stage, was in this cycle.
  void set_link(std::size_t link, const LinkState& state) { links_[link].state = state; }
  void set_stage(std::size_t stage, int activity);
  /// Behind all of these: draws the cycle when it is in the window.
  void end_cycle(pipeline::Cycle now);
  void close() { writer_->close(); }

 private:
  struct WatchedLink {
    LinkState state;
    int occupancy = 0;  ///< at the start of the cycle
  };
  std::vector<WatchedLink> links_;
  std::vector<std::string> stage_names_;
  std::vector<pipeline::Account> stages_;
  pipeline::Probes probes_;
  std::unique_ptr<pipeline::WaveWriter> writer_;
};

}  // namespace ctu::cosim
