// One run with everything that is needed to understand and repeat it: as JSON for programs, as a table for people.
#pragma once

#include <string>

#include "model/pipeline/result.h"
#include "model/pipeline/unit_config.h"

namespace ctu::sim {

/// Of engine "both".
struct TwinComparison {
  std::uint64_t handshakes = 0, signals = 0;  ///< compared
  std::string first_difference;               ///< empty: none
  std::string waves;  ///< with a difference: PREFIX of both waveforms around it, PREFIX.model.vcd and PREFIX.rtl.vcd
};

struct RunRecord {
  std::string engine;  ///< "reference" (untimed: no cycles), "cycle", "rtl", or "both"
  std::string mode;    ///< of the cycle engine: "plain", "batch", "cycle", "pins"
  std::string source;  ///< "replay" or "exec"
  std::string trace_path, trace_hash, scene;
  std::string command;  ///< as it was typed
  pipeline::UnitConfig config;
  std::string config_hash;
  std::string design;
  pipeline::UnitResult result;
  TwinComparison twins;
  double wall_seconds = 0;       ///< of the simulation alone, without loading
  double processor_seconds = 0;  ///< likewise, of one core: what other programs take of a shared machine is not in it

  bool timed() const { return engine != "reference"; }
  double cycles_per_ray() const;
  double cycles_per_second() const;
  double rays_per_second() const;
};

/// Error unless a result can be written there: asked before a long run, not after it.
void check_writable(const std::string& path);

/// Writes the result file; Error when it cannot be written.
void write_json(const RunRecord& record, const std::string& path);

/// The run for people: the sums, busy/stalled/idle of every stage, where rays spent their time, counters.
void print_record(const RunRecord& record);

}  // namespace ctu::sim
