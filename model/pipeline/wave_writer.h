// Waveforms as a value change dump (IEEE 1364) of every link's valid, ready and occupancy and every stage's activity.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "model/pipeline/probe.h"

namespace ctu::pipeline {

/// One nanosecond of the dump is one cycle. Activities are numbers in the order of enum Activity, explained in the
/// header.
class WaveWriter {
 public:
  /// Writes cycles [first, last]. Throws Error when the file cannot be written.
  WaveWriter(const std::string& path, const Probes& probes, Cycle first, Cycle last);
  ~WaveWriter();
  WaveWriter(const WaveWriter&) = delete;
  WaveWriter& operator=(const WaveWriter&) = delete;

  Cycle first() const { return first_; }
  bool wants(Cycle now) const { return now >= first_ && now <= last_; }
  /// The links as they are at the start of cycle `now`: to be called before the stages step.
  void sample_links(Cycle now);
  /// The stages' activity in `now`: to be called after they have stepped.
  void sample_stages(Cycle now);
  /// Ends the dump. Throws Error when something could not be written.
  void close();

 private:
  struct Signal {
    std::string code;
    int bits;
    int last = -1;
  };
  void declare(const std::string& name, int bits);
  void change(Signal& signal, int value, Cycle now);

  const Probes& probes_;
  Cycle first_, last_, stamped_ = kNever;
  std::string path_;
  std::FILE* file_ = nullptr;
  std::vector<Signal> signals_;
};

}  // namespace ctu::pipeline
