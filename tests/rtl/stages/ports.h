// Verilated ports of any width as words of 32 bits, lowest first.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace ctu::rtl {

/// Words of a port: one up to 32 bits, two up to 64.
template <class Port>
constexpr std::size_t words_of() {
  return sizeof(Port) < 4 ? 1 : sizeof(Port) / 4;
}

/// `words`: at least as many as the port has.
template <class Port>
void set_port(Port& port, const std::vector<std::uint32_t>& words) {
  if constexpr (!std::is_integral_v<Port>)
    std::copy_n(words.data(), words_of<Port>(), port.data());
  else if constexpr (sizeof(Port) == 8)
    port = words[0] | static_cast<std::uint64_t>(words[1]) << 32;
  else
    port = static_cast<Port>(words[0]);
}

template <class Port>
std::vector<std::uint32_t> get_port(const Port& port) {
  std::vector<std::uint32_t> words(words_of<Port>());
  if constexpr (!std::is_integral_v<Port>)
    std::copy_n(port.data(), words.size(), words.data());
  else
    for (std::size_t i = 0; i < words.size(); ++i)
      words[i] = static_cast<std::uint32_t>(std::uint64_t{port} >> (32 * i));
  return words;
}

}  // namespace ctu::rtl
