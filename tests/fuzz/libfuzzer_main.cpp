// The harness that CTU_FUZZ names, under libFuzzer; without it, the names and the bytes of their longest inputs.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/fuzz/harness.h"

namespace {

const ctu::fuzz::Harness* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("CTU_FUZZ");
  chosen = name == nullptr ? nullptr : ctu::fuzz::find_harness(name);
  if (chosen != nullptr) return 0;
  for (const auto& harness : ctu::fuzz::harnesses())
    std::printf("%s %zu\n", std::string(harness.name).c_str(), harness.longest_bytes);
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen->run({data, size});
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    std::abort();
  }
  return 0;
}
