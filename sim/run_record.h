// One run with everything that is needed to understand and repeat it: as JSON for programs, as a table for people.
#pragma once

#include <string>

#include "model/pipeline/result.h"
#include "model/pipeline/unit_config.h"
#include "sim/energy/cost_report.h"

namespace ctu::sim {

/// Of engine "both".
struct TwinComparison {
  std::uint64_t handshakes = 0, signals = 0;  ///< compared
  std::string first_difference;               ///< empty: none
  std::string waves;  ///< with a difference: PREFIX of both waveforms around it, PREFIX.model.vcd and PREFIX.rtl.vcd
};

/// Of engines "estimate" and "sampled".
struct Approximation {
  std::string limit;  ///< estimate: the stage that limits, or "contexts"
  /// sampled: the interval that holds the cycles of the whole run with this probability, in percent.
  double confidence = 0, cycles_low = 0, cycles_high = 0;
  std::uint64_t chunks = 0, simulated_rays = 0, simulated_cycles = 0;  ///< sampled: warm-up included
};

struct RunRecord {
  std::string engine;  ///< "reference" (untimed: no cycles), "cycle", "rtl", "both", "estimate" or "sampled"
  std::string mode;    ///< of the cycle engine: "plain", "batch", "cycle", "pins"
  std::string source;  ///< "replay" or "exec"
  std::string trace_path, trace_hash, scene;
  std::string command;  ///< as it was typed
  pipeline::UnitConfig config;
  std::string config_hash;
  std::string design;
  pipeline::UnitResult result;
  TwinComparison twins;
  Approximation approximation;
  energy::CostReport cost;
  double wall_seconds = 0;       ///< of the simulation alone, without loading
  double processor_seconds = 0;  ///< likewise, of one core: what other programs take of a shared machine is not in it

  bool timed() const { return engine != "reference"; }
  /// Whether every ray was run and its hit checked.
  bool runs_rays() const { return engine != "estimate" && engine != "sampled"; }
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
