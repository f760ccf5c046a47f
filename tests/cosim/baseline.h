// The cycles that each configuration takes for each trace, as they were when somebody last agreed to them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace ctu::cosim {

class Baseline {
 public:
  /// Lines of "config hash,trace,rays,cycles" behind a heading. Throws Error when the file cannot be read or has
  /// another form.
  explicit Baseline(std::string path);

  /// What is wrong with a run's cycles; empty: nothing. `key` is "config hash,trace,rays".
  std::string complaint(const std::string& key, std::uint64_t cycles) const;
  void set(const std::string& key, std::uint64_t cycles) { cycles_[key] = cycles; }
  void write() const;

 private:
  std::string path_;
  std::map<std::string, std::uint64_t> cycles_;
};

}  // namespace ctu::cosim
