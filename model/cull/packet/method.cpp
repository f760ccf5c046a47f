#include "model/cull/packet/method.h"

namespace ctu::cull::packet {

std::string_view to_string(Method method) {
  switch (method) {
    case Method::Interval:
      return "interval";
    case Method::AxisInterval:
      return "axis-interval";
    case Method::Planes:
      return "planes";
    case Method::CornerRays:
      return "corner-rays";
    case Method::Affine:
      return "affine";
  }
  return "";
}

Bounds::Any Bounds::make(Method method, const Lines& lines) {
  switch (method) {
    case Method::Planes:
      return BoundingPlanes(lines);
    case Method::CornerRays:
      return CornerRays(lines);
    case Method::Affine:
      return AffineBounds(lines);
    case Method::Interval:
    case Method::AxisInterval:
      break;
  }
  return IntervalBounds(lines);
}

Bounds::Bounds(Method method, const Lines& lines) : bounds_(make(method, lines)) {}

}  // namespace ctu::cull::packet
