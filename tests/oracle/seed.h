// Where random tests get their seed: CTU_TEST_SEED if it is set, else a fixed number, so that a run is repeatable.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace ctu::oracle {

inline std::uint64_t test_seed() {
  const char* given = std::getenv("CTU_TEST_SEED");
  return given ? std::strtoull(given, nullptr, 0) : 20240229u;
}

/// For SCOPED_TRACE: how to repeat the run.
inline std::string seed_note() { return "CTU_TEST_SEED=" + std::to_string(test_seed()); }

}  // namespace ctu::oracle
