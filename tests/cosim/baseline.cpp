#include "tests/cosim/baseline.h"

#include <fstream>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::cosim {
namespace {

constexpr const char* kHeading = "config hash,trace,rays,cycles";

}  // namespace

Baseline::Baseline(std::string path) : path_(std::move(path)) {
  std::ifstream in(path_);
  std::string line;
  if (!std::getline(in, line) || line != kHeading)
    throw Error(path_, "is no baseline of cycles", fmt::format("begin it with the line \"{}\"", kHeading));
  while (std::getline(in, line)) {
    const auto comma = line.rfind(',');
    if (comma == std::string::npos) throw Error(path_, fmt::format("\"{}\" has no cycles", line), "make it anew");
    cycles_[line.substr(0, comma)] = std::stoull(line.substr(comma + 1));
  }
}

std::string Baseline::complaint(const std::string& key, std::uint64_t cycles) const {
  const auto known = cycles_.find(key);
  if (known == cycles_.end()) return "is not in the baseline";
  if (known->second == cycles) return {};
  return fmt::format("takes {} cycles, the baseline has {} ({:+.2f} %)", cycles, known->second,
                     100.0 * (static_cast<double>(cycles) / static_cast<double>(known->second) - 1));
}

void Baseline::write() const {
  std::ofstream out(path_);
  out << kHeading << '\n';
  for (const auto& [key, cycles] : cycles_) out << key << ',' << cycles << '\n';
  if (!out.flush()) throw Error(path_, "cannot be written", "check the folder and its permissions");
}

}  // namespace ctu::cosim
