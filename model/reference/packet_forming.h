// Which rays travel together: packets cut from a window of consecutive rays, as they come or sorted so that neighbours
// are alike.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/intersect/ray.h"

namespace ctu::reference {

inline constexpr int kLeastPacket = 4, kMostPacket = 64;

enum class Forming : std::uint8_t {
  Order,      ///< as they come
  Direction,  ///< by the signs of the direction, then by where it points
  Origin,     ///< by the signs of the direction, then by where it starts, then by where it points
};

/// "order", "direction", "origin".
std::string_view to_string(Forming forming);
std::optional<Forming> forming_from_string(std::string_view name);

struct FormingOptions {
  int size = 16;     ///< rays in a packet, kLeastPacket .. kMostPacket
  int window = 256;  ///< consecutive rays that packets are made from, at least `size`
  Forming forming = Forming::Order;
};

/// Throws Error naming the option that is out of range.
void check(const FormingOptions& options);

/// Places of rays in `rays`, packet after packet. Each valid ray is in one packet; the last packet of a window may be
/// small. Rays that are not valid are in none.
std::vector<std::vector<std::uint32_t>> form_packets(std::span<const intersect::Ray> rays,
                                                     const FormingOptions& options);

/// The same rays one after the other, packet after packet: all places of `rays`, those of rays that are not valid
/// behind the others of their window.
std::vector<std::uint32_t> packet_order(std::span<const intersect::Ray> rays, const FormingOptions& options);

}  // namespace ctu::reference
