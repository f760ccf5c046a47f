// What is fuzzed: one function for each kind of input, given any bytes whatever. Run by libFuzzer (libfuzzer_main.cpp)
// and, in the ordinary build, by ctu_fuzz_replay (replay_main.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "model/base/error.h"

namespace ctu::fuzz {

using Input = std::span<const std::uint8_t>;

struct Harness {
  std::string_view name;  ///< also of its folder in corpus/ and its dictionary
  std::string_view what;
  std::size_t longest_bytes;  ///< of an input worth trying
  /// Returns when the input was taken or refused with an Error. Whatever else is thrown is a defect, as is a signal.
  void (*run)(Input input);
};

/// All of them, in a fixed order.
std::span<const Harness> harnesses();

/// Null when there is none of this name.
const Harness* find_harness(std::string_view name);

/// A property that an input broke.
class Defect : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& property) {
  if (!holds) throw Defect("does not hold: " + property);
}

/// Whether `body` took its input; a refusal must say where, what and what to do.
template <class Body>
bool accepts(Body&& body) {
  try {
    body();
    return true;
  } catch (const Error& refusal) {
    require(!refusal.where().empty() && !refusal.problem().empty(), "a refusal names its place and its problem");
    return false;
  }
}

inline std::string_view as_text(Input input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

}  // namespace ctu::fuzz
