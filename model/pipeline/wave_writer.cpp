#include "model/pipeline/wave_writer.h"

#include <cerrno>
#include <cstring>

#include "model/base/error.h"

namespace ctu::pipeline {
namespace {

constexpr int kLinkSignals = 3;
constexpr int kActivityBits = 4;
static_assert(kActivities <= 1 << kActivityBits);

/// Identifier of signal `number`: printable characters, shortest first.
std::string code_of(std::size_t number) {
  std::string code;
  do {
    code += static_cast<char>('!' + number % 94);
    number /= 94;
  } while (number > 0);
  return code;
}

}  // namespace

WaveWriter::WaveWriter(const std::string& path, const Probes& probes, Cycle first, Cycle last)
    : probes_(probes), first_(first), last_(last), path_(path) {
  file_ = std::fopen(path.c_str(), "w");
  if (file_ == nullptr) throw Error(path, std::strerror(errno), "name a file that can be written");
  std::fputs("$comment activity:", file_);
  for (int i = 0; i < kActivities; ++i)
    std::fprintf(file_, " %d=%s", i, std::string(name_of(static_cast<Activity>(i))).c_str());
  std::fputs(" $end\n$timescale 1 ns $end\n$scope module ctu $end\n$scope module links $end\n", file_);
  for (const LinkProbe& link : probes.links) {
    std::fprintf(file_, "$scope module %s $end\n", link.name.c_str());
    declare("valid", 1);
    declare("ready", 1);
    declare("occupancy", 2);
    std::fputs("$upscope $end\n", file_);
  }
  std::fputs("$upscope $end\n$scope module stages $end\n", file_);
  for (const Account* stage : probes.stages) declare(std::string(stage->stage()), kActivityBits);
  std::fputs("$upscope $end\n$upscope $end\n$enddefinitions $end\n", file_);
}

WaveWriter::~WaveWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void WaveWriter::declare(const std::string& name, int bits) {
  signals_.push_back({code_of(signals_.size()), bits, -1});
  std::fprintf(file_, "$var wire %d %s %s $end\n", bits, signals_.back().code.c_str(), name.c_str());
}

void WaveWriter::change(Signal& signal, int value, Cycle now) {
  if (value == signal.last) return;
  signal.last = value;
  if (stamped_ != now) std::fprintf(file_, "#%llu\n", static_cast<unsigned long long>(now));
  stamped_ = now;
  if (signal.bits == 1) {
    std::fprintf(file_, "%d%s\n", value, signal.code.c_str());
    return;
  }
  std::fputc('b', file_);
  for (int bit = signal.bits - 1; bit >= 0; --bit) std::fputc('0' + ((value >> bit) & 1), file_);
  std::fprintf(file_, " %s\n", signal.code.c_str());
}

void WaveWriter::sample_links(Cycle now) {
  for (std::size_t i = 0; i < probes_.links.size(); ++i) {
    const LinkProbe& link = probes_.links[i];
    change(signals_[kLinkSignals * i], link.valid(now), now);
    change(signals_[kLinkSignals * i + 1], link.ready(now), now);
    change(signals_[kLinkSignals * i + 2], link.occupancy(), now);
  }
}

void WaveWriter::sample_stages(Cycle now) {
  const std::size_t base = kLinkSignals * probes_.links.size();
  for (std::size_t i = 0; i < probes_.stages.size(); ++i)
    change(signals_[base + i], static_cast<int>(probes_.stages[i]->current()), now);
}

void WaveWriter::close() {
  const bool failed = std::ferror(file_) != 0;
  const bool not_closed = std::fclose(file_) != 0;
  file_ = nullptr;
  if (failed || not_closed) throw Error(path_, "the waveform could not be written", "make room on the disk");
}

}  // namespace ctu::pipeline
