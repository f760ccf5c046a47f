// The ways to bound a packet side by side: one of them made for one packet, asked about primitives.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <variant>

#include "model/cull/packet/affine_bounds.h"
#include "model/cull/packet/bounding_planes.h"
#include "model/cull/packet/corner_rays.h"
#include "model/cull/packet/interval_bounds.h"

namespace ctu::cull::packet {

enum class Method : std::uint8_t {
  Interval,      ///< on the rays as they are given, as the paper has it
  AxisInterval,  ///< on rays that all advance by 1 along the major axis
  Planes,
  CornerRays,
  Affine,
};
inline constexpr std::array kMethods = {Method::Interval, Method::AxisInterval, Method::Planes, Method::CornerRays,
                                        Method::Affine};

/// "interval", "axis-interval", "planes", "corner-rays", "affine".
std::string_view to_string(Method method);

/// The scale that a method takes its lines in.
constexpr Scale scale_of(Method method) { return method == Method::Interval ? Scale::AsGiven : Scale::MajorAxis; }

class Bounds {
 public:
  /// `lines` as of scale_of(method).
  Bounds(Method method, const Lines& lines);

  /// Undecided where the method has no test for such a primitive.
  template <class Primitive>
  Answer test(const Primitive& primitive, const Reach& reach = {}) const {
    const auto ask = [&](const auto& bounds) {
      if constexpr (requires { bounds.test(primitive, reach); })
        return bounds.test(primitive, reach);
      else
        return Answer::Undecided;
    };
    return std::visit(ask, bounds_);
  }

 private:
  using Any = std::variant<IntervalBounds, BoundingPlanes, CornerRays, AffineBounds>;
  static Any make(Method method, const Lines& lines);
  Any bounds_;
};

}  // namespace ctu::cull::packet
