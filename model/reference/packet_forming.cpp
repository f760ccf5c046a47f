#include "model/reference/packet_forming.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "model/base/error.h"

namespace ctu::reference {
namespace {

using intersect::Ray;

constexpr int kBits = 10;  ///< of each coordinate of a place on a curve

/// The bits of three numbers in turn: neighbours in space are mostly neighbours on the line (Morton order).
std::uint64_t interleaved(const std::uint32_t (&number)[3]) {
  std::uint64_t code = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (const std::uint32_t n : number) code = code << 1 | (n >> bit & 1u);
  return code;
}

/// Which of 2^kBits steps from `least` to `most` x lies in.
std::uint32_t step_of(double x, double least, double most) {
  constexpr double kSteps = 1 << kBits;
  if (!(most > least)) return 0;
  return static_cast<std::uint32_t>(std::clamp((x - least) / (most - least) * kSteps, 0.0, kSteps - 1));
}

struct Extent {
  Vec3 lo, hi;
};

Extent extent_of_origins(std::span<const Ray> rays, std::span<const std::uint32_t> members) {
  Extent extent{rays[members.front()].origin, rays[members.front()].origin};
  for (const std::uint32_t i : members)
    for (int axis = 0; axis < 3; ++axis) {
      extent.lo[axis] = std::min(extent.lo[axis], rays[i].origin[axis]);
      extent.hi[axis] = std::max(extent.hi[axis], rays[i].origin[axis]);
    }
  return extent;
}

std::uint64_t signs(const Vec3& d) {
  return static_cast<std::uint64_t>(std::signbit(d.x)) << 2 | static_cast<std::uint64_t>(std::signbit(d.y)) << 1 |
         static_cast<std::uint64_t>(std::signbit(d.z));
}

std::uint64_t direction_code(const Vec3& d) {
  double length = 0;
  for (int axis = 0; axis < 3; ++axis) length += std::fabs(static_cast<double>(d[axis]));
  std::uint32_t steps[3];
  for (int axis = 0; axis < 3; ++axis) steps[axis] = step_of(d[axis] / length, -1, 1);
  return interleaved(steps);
}

std::uint64_t origin_code(const Vec3& origin, const Extent& extent) {
  std::uint32_t steps[3];
  for (int axis = 0; axis < 3; ++axis) steps[axis] = step_of(origin[axis], extent.lo[axis], extent.hi[axis]);
  return interleaved(steps);
}

void sort_window(std::span<const Ray> rays, Forming forming, std::vector<std::uint32_t>& members) {
  if (forming == Forming::Order || members.empty()) return;
  const Extent extent = extent_of_origins(rays, members);
  struct Key {
    std::uint64_t first, second;
    std::uint32_t ray;
    bool operator<(const Key& o) const { return std::tie(first, second, ray) < std::tie(o.first, o.second, o.ray); }
  };
  std::vector<Key> keys;
  for (const std::uint32_t i : members) {
    const Ray& ray = rays[i];
    const std::uint64_t octant = signs(ray.direction) << (3 * kBits), to = direction_code(ray.direction);
    if (forming == Forming::Direction)
      keys.push_back({octant | to, 0, i});
    else
      keys.push_back({octant | origin_code(ray.origin, extent), to, i});
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i) members[i] = keys[i].ray;
}

}  // namespace

std::string_view to_string(Forming forming) {
  constexpr std::string_view kNames[] = {"order", "direction", "origin"};
  return kNames[static_cast<std::size_t>(forming)];
}

std::optional<Forming> forming_from_string(std::string_view name) {
  for (const Forming forming : {Forming::Order, Forming::Direction, Forming::Origin})
    if (to_string(forming) == name) return forming;
  return std::nullopt;
}

void check(const FormingOptions& options) {
  if (options.size < kLeastPacket || options.size > kMostPacket)
    throw Error("packet size", fmt::format("{} rays", options.size),
                fmt::format("give {} to {}", kLeastPacket, kMostPacket));
  if (options.window < options.size)
    throw Error("packet window", fmt::format("{} rays, fewer than a packet's {}", options.window, options.size),
                "give at least the packet size");
}

namespace {

/// The valid rays of the window that begins at `begin`, in the order in which they travel.
std::vector<std::uint32_t> members_of_window(std::span<const Ray> rays, const FormingOptions& options,
                                             std::size_t begin) {
  std::vector<std::uint32_t> members;
  for (std::size_t i = begin; i < std::min(begin + static_cast<std::size_t>(options.window), rays.size()); ++i)
    if (intersect::is_valid(rays[i])) members.push_back(static_cast<std::uint32_t>(i));
  sort_window(rays, options.forming, members);
  return members;
}

}  // namespace

std::vector<std::uint32_t> packet_order(std::span<const Ray> rays, const FormingOptions& options) {
  check(options);
  const auto window = static_cast<std::size_t>(options.window);
  std::vector<std::uint32_t> order;
  for (std::size_t begin = 0; begin < rays.size(); begin += window) {
    const std::vector<std::uint32_t> members = members_of_window(rays, options, begin);
    order.insert(order.end(), members.begin(), members.end());
    for (std::size_t i = begin; i < std::min(begin + window, rays.size()); ++i)
      if (!intersect::is_valid(rays[i])) order.push_back(static_cast<std::uint32_t>(i));
  }
  return order;
}

std::vector<std::vector<std::uint32_t>> form_packets(std::span<const Ray> rays, const FormingOptions& options) {
  check(options);
  const auto size = static_cast<std::size_t>(options.size), window = static_cast<std::size_t>(options.window);
  std::vector<std::vector<std::uint32_t>> packets;
  for (std::size_t begin = 0; begin < rays.size(); begin += window) {
    const std::vector<std::uint32_t> members = members_of_window(rays, options, begin);
    for (std::size_t i = 0; i < members.size(); i += size)
      packets.emplace_back(members.begin() + static_cast<std::ptrdiff_t>(i),
                           members.begin() + static_cast<std::ptrdiff_t>(std::min(i + size, members.size())));
  }
  return packets;
}

}  // namespace ctu::reference
