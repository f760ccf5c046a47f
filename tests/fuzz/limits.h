// What one input may cost, and what is kept of one that costs more or ends the process.
#pragma once

#include <cstddef>
#include <string>

#include "tests/fuzz/harness.h"

namespace ctu::fuzz {

inline constexpr unsigned kMostSeconds = 10;                     ///< of one input
inline constexpr std::size_t kMostBytes = std::size_t{2} << 30;  ///< of address space, of the whole process

/// More than `bytes` cannot be had from here on: allocations fail. Nothing under a sanitizer, which reserves far more.
void limit_memory(std::size_t bytes);

/// While it lives, an input that takes longer than kMostSeconds or ends the process by a signal is written to a file
/// named in `file`, a message says how to replay it, and the process ends with code 1.
class Watch {
 public:
  Watch(const Harness& harness, Input input, const std::string& file);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
};

}  // namespace ctu::fuzz
