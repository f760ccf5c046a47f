#include "tests/oracle/exact_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/oracle/rational.h"

namespace ctu::oracle {

namespace {

/// The ray's points inside cell i of one axis; `false` when there are none.
bool clip_to_cell(const intersect::Ray& ray, int axis, const Rational& lower, const Rational& upper, bool upper_open,
                  Span& span) {
  const Rational o = exact(ray.origin[axis]), d = exact(ray.direction[axis]);
  if (d == 0) return lower <= o && (upper_open ? o < upper : o <= upper);
  const Rational at_lower = (lower - o) / d, at_upper = (upper - o) / d;
  if (d > 0) {
    span.start_at(at_lower);
    span.stop_at(at_upper, upper_open);
  } else {
    span.start_at(at_upper, upper_open);
    span.stop_at(at_lower);
  }
  return !span.empty();
}

void intersect_with(Span& span, const Span& other) {
  if (!other.from.infinite) span.start_at(other.from.at, other.from.open);
  if (!other.to.infinite) span.stop_at(other.to.at, other.to.open);
}

struct AxisCells {
  std::vector<std::uint8_t> touched;
  std::vector<Span> spans;
};

AxisCells cells_of_axis(const intersect::Ray& ray, int axis, float lo, float hi, int resolution, Cells cells) {
  AxisCells result;
  const Rational from = exact(lo), size = exact(hi) - from;
  for (int i = 0; i < resolution; ++i) {
    const bool flat = size == 0, half_open = cells == Cells::HalfOpen;
    const Rational lower = from + size * i / resolution, upper = from + size * (i + 1) / resolution;
    Span span;
    const bool open = half_open && !flat && i + 1 < resolution;
    const bool touched = !(half_open && flat && i > 0) && clip_to_cell(ray, axis, lower, upper, open, span);
    result.touched.push_back(touched);
    result.spans.push_back(span);
  }
  return result;
}

using Integer = mpz_class;
using Vec3z = std::array<Integer, 3>;

/// Numbers as integer multiples of 2^-149, the last place of binary32: all of them exactly.
Integer in_last_places(float x) {
  int exponent = 0;
  const double fraction = std::frexp(static_cast<double>(x), &exponent);
  const Integer significand(std::ldexp(fraction, 24));
  const int shift = exponent - 24 + 149;  // negative for subnormals only, whose low bits are zero
  return shift >= 0 ? Integer(significand << static_cast<unsigned long>(shift))
                    : Integer(significand >> static_cast<unsigned long>(-shift));
}

Vec3z scaled(const Vec3& v, int factor) {
  return {in_last_places(v.x) * factor, in_last_places(v.y) * factor, in_last_places(v.z) * factor};
}
Vec3z operator-(const Vec3z& a, const Vec3z& b) {
  return {Integer(a[0] - b[0]), Integer(a[1] - b[1]), Integer(a[2] - b[2])};
}
Vec3z cross(const Vec3z& a, const Vec3z& b) {
  return {Integer(a[1] * b[2] - a[2] * b[1]), Integer(a[2] * b[0] - a[0] * b[2]), Integer(a[0] * b[1] - a[1] * b[0])};
}
Integer dot(const Vec3z& a, const Vec3z& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The thirteen directions along which a triangle and a box can be told apart; zero ones tell nothing. They suffice
/// for triangles without area and flat boxes too: then the directions normal to an edge or a face still span the
/// normals of the flattened Minkowski difference.
std::vector<Vec3z> separating_directions(const std::array<Vec3z, 3>& v) {
  std::vector<Vec3z> directions;
  const Vec3z unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec3z edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  for (const Vec3z& axis : unit) directions.push_back(axis);
  directions.push_back(cross(edges[0], edges[1]));
  for (const Vec3z& axis : unit) {
    for (const Vec3z& edge : edges) directions.push_back(cross(axis, edge));
  }
  return directions;
}

/// One direction: the triangle's extent along it, and what the box's corner and size contribute.
struct Direction {
  Vec3z along;
  Integer triangle_low, triangle_high, cell_low, cell_high;  ///< of the cell at the grid's origin

  Direction(const Vec3z& direction, const std::array<Vec3z, 3>& v, const Vec3z& corner, const Vec3z& size)
      : along(direction) {
    const Integer at[3] = {dot(along, v[0]), dot(along, v[1]), dot(along, v[2])};
    triangle_low = *std::min_element(at, at + 3);
    triangle_high = *std::max_element(at, at + 3);
    cell_low = cell_high = dot(along, corner);
    for (int axis = 0; axis < 3; ++axis) {
      const Integer step = along[axis] * size[axis];
      if (step < 0)
        cell_low += step;
      else
        cell_high += step;
    }
  }
  bool separates(const Integer& offset) const {
    return cell_high + offset < triangle_low || triangle_high < cell_low + offset;
  }
};

}  // namespace

std::vector<std::uint8_t> exact_ray_cells(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution,
                                          float t0, float t1, Cells cells) {
  const auto r = static_cast<std::size_t>(resolution);
  std::vector<std::uint8_t> touched(r * r * r, 0);
  AxisCells axis[3];
  for (int a = 0; a < 3; ++a) axis[a] = cells_of_axis(ray, a, lo[a], hi[a], resolution, cells);
  Span all;
  clip(all, t0, t1);
  for (std::size_t z = 0; z < r; ++z) {
    Span in_z = all;
    intersect_with(in_z, axis[2].spans[z]);
    if (!axis[2].touched[z] || in_z.empty()) continue;
    for (std::size_t y = 0; y < r; ++y) {
      Span in_y = in_z;
      intersect_with(in_y, axis[1].spans[y]);
      if (!axis[1].touched[y] || in_y.empty()) continue;
      for (std::size_t x = 0; x < r; ++x) {
        Span in_x = in_y;
        intersect_with(in_x, axis[0].spans[x]);
        touched[x + r * (y + r * z)] = axis[0].touched[x] && !in_x.empty();
      }
    }
  }
  return touched;
}

std::vector<std::uint8_t> exact_triangle_cells(const Vec3& lo, const Vec3& hi, int resolution, const Vec3& v0,
                                               const Vec3& v1, const Vec3& v2) {
  const auto r = static_cast<std::size_t>(resolution);
  std::vector<std::uint8_t> touched(r * r * r, 0);
  // Everything times R: then the cell's size is hi - lo and its corner R lo + i (hi - lo), without a division.
  const std::array<Vec3z, 3> v{scaled(v0, resolution), scaled(v1, resolution), scaled(v2, resolution)};
  const Vec3z corner = scaled(lo, resolution), size = scaled(hi, 1) - scaled(lo, 1);
  std::vector<Direction> directions;
  for (const Vec3z& along : separating_directions(v)) directions.emplace_back(along, v, corner, size);
  for (std::size_t z = 0; z < r; ++z) {
    for (std::size_t y = 0; y < r; ++y) {
      for (std::size_t x = 0; x < r; ++x) {
        const Vec3z shift{Integer(size[0] * x), Integer(size[1] * y), Integer(size[2] * z)};
        touched[x + r * (y + r * z)] = std::none_of(
            directions.begin(), directions.end(), [&](const Direction& d) { return d.separates(dot(d.along, shift)); });
      }
    }
  }
  return touched;
}

bool exact_triangle_touches_box(const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& lo, const Vec3& hi) {
  return exact_triangle_cells(lo, hi, 1, v0, v1, v2)[0] != 0;
}

}  // namespace ctu::oracle
