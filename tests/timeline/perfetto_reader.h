// Decodes a trace of Perfetto track events back from its bytes, as its readers do: only from the wire format and the
// field numbers.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ctu::test {

struct Slice {
  std::string name;
  std::uint64_t begin = 0, end = 0;
  int depth = 0;
};

struct PerfettoTrack {
  std::string name, process;
  std::uint64_t parent = 0;
  bool counter = false;
  std::vector<Slice> slices;                                      ///< in the order in which they begin
  std::vector<std::pair<std::uint64_t, std::int64_t>> counted{};  ///< time and value
};

/// Tracks by their number. Fails the test on events of no track, names of no number, ends without a begin, times that
/// go back.
std::map<std::uint64_t, PerfettoTrack> read_perfetto(const std::string& bytes);

}  // namespace ctu::test
