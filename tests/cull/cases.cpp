#include "tests/cull/cases.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>

namespace ctu::test {

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {.name = "near"},
      {.name = "origin inside", .offset = 0},
      {.name = "origin inside, range cut", .offset = 0, .cut = true},
      {.name = "range cut", .cut = true},
      {.name = "far 1e2", .offset = 1e2f},
      {.name = "far 1e4", .offset = 1e4f},
      {.name = "far 1e6", .offset = 1e6f},
      {.name = "aspect 1000", .aspect = 1000},
      {.name = "aspect 1000, far 1e4", .offset = 1e4f, .aspect = 1000},
      {.name = "zero axes", .zero_axes = true},
      {.name = "zero axes, origin inside", .offset = 0, .zero_axes = true},
      {.name = "lattice", .lattice = true},
      {.name = "lattice, zero axes", .lattice = true, .zero_axes = true},
      {.name = "lattice, origin inside", .offset = 0, .lattice = true, .cut = true},
      {.name = "flat", .flat = true},
      {.name = "flat lattice", .lattice = true, .zero_axes = true, .flat = true},
      {.name = "tiny", .scale = 1e-30f},
      {.name = "subnormal", .scale = 1e-41f},
      {.name = "huge", .scale = 1e30f},
  };
  return all;
}

std::string identifier(const Family& family) {
  std::string name = family.name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

void CaseMaker::box(const Family& family, Vec3& lo, Vec3& hi) {
  const int long_axis = integer(0, 2), flat_axis = family.flat ? integer(0, 2) : -1;
  for (int a = 0; a < 3; ++a) {
    float extent = family.lattice ? static_cast<float>(integer(1, 8)) : uniform(0.2f, 2.0f);
    if (a != long_axis) extent /= family.aspect;
    if (a == flat_axis) extent = 0;
    lo[a] = (family.lattice ? static_cast<float>(integer(-4, 4)) : uniform(-2, 2)) * family.scale;
    hi[a] = lo[a] + extent * family.scale;
  }
}

Vec3 CaseMaker::point_in(const Family& family, const Vec3& lo, const Vec3& hi) {
  Vec3 p;
  for (int a = 0; a < 3; ++a) {
    // A lattice of eighths meets the cell planes of R = 2, 4, 8 often.
    const float share =
        family.lattice || integer(0, 7) == 0 ? 0.125f * static_cast<float>(integer(0, 8)) : uniform(0, 1);
    p[a] = std::clamp(lo[a] + share * (hi[a] - lo[a]), lo[a], hi[a]);
  }
  return p;
}

intersect::Ray CaseMaker::ray_to(const Family& family, const Vec3& lo, const Vec3& hi, const Vec3& target) {
  intersect::Ray ray;
  float length = 0;
  for (int a = 0; a < 3; ++a) length = std::max(length, hi[a] - lo[a]);
  do {
    for (int a = 0; a < 3; ++a) {
      ray.direction[a] = family.lattice ? static_cast<float>(integer(-4, 4)) : uniform(-1, 1);
      if (family.zero_axes && integer(0, 2) == 0) ray.direction[a] = integer(0, 1) == 0 ? 0.0f : -0.0f;
    }
  } while (ray.direction == Vec3{});
  const float steps = family.lattice ? static_cast<float>(integer(0, 2)) : uniform(0.5f, 1);
  const float distance = length * family.offset * steps;
  for (int a = 0; a < 3; ++a) ray.origin[a] = target[a] - distance * ray.direction[a];
  if (family.offset == 0) {
    ray.origin = point_in(family, lo, hi);
    if (!family.lattice && !family.zero_axes && !(ray.origin == target))
      for (int a = 0; a < 3; ++a) ray.direction[a] = target[a] - ray.origin[a];
    if (ray.direction == Vec3{}) ray.direction = {1, 0, 0};
  }
  ray.tmin = 0;
  ray.tmax = std::numeric_limits<float>::infinity();
  if (family.cut) {
    const float a = uniform(0, 1) * (distance + length), b = uniform(0, 1) * (distance + length);
    ray.tmin = std::min(a, b);
    ray.tmax = std::max(a, b) + length * 0.2f;
  }
  return ray;
}

RayAndBox CaseMaker::ray_and_box(const Family& family) {
  RayAndBox c;
  box(family, c.lo, c.hi);
  c.ray = ray_to(family, c.lo, c.hi, point_in(family, c.lo, c.hi));
  return c;
}

void CaseMaker::triangle(const Family& family, const Vec3& lo, const Vec3& hi, Vec3 (&vertices)[3]) {
  for (Vec3& v : vertices) v = point_in(family, lo, hi);
  switch (integer(0, 7)) {
    case 0:
      vertices[2] = vertices[1];
      break;  // a segment
    case 1:
      vertices[2] = vertices[1] = vertices[0];
      break;  // a point
    case 2:   // thin
      for (int a = 0; a < 3; ++a)
        vertices[2][a] = std::clamp(vertices[1][a] + 0.01f * (vertices[2][a] - vertices[1][a]), lo[a], hi[a]);
      break;
    case 3: {  // in a plane of the grid
      const int a = integer(0, 2);
      vertices[1][a] = vertices[2][a] = vertices[0][a];
      break;
    }
    default:
      break;
  }
}

Vec3 CaseMaker::point_of(const Vec3 (&vertices)[3]) {
  float u = uniform(0, 1), v = uniform(0, 1 - u);
  const int kind = integer(0, 3);
  if (kind == 0) return vertices[integer(0, 2)];
  if (kind == 1) v = 0;
  Vec3 p;
  for (int a = 0; a < 3; ++a)
    p[a] = vertices[0][a] + u * (vertices[1][a] - vertices[0][a]) + v * (vertices[2][a] - vertices[0][a]);
  return p;
}

intersect::Box4 box_in_lane_0(const Vec3& lo, const Vec3& hi) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  intersect::Box4 boxes;
  for (int a = 0; a < 3; ++a)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      boxes.lo[a][lane] = lane == 0 ? lo[a] : kInfinity;
      boxes.hi[a][lane] = lane == 0 ? hi[a] : -kInfinity;
    }
  return boxes;
}

void bounds_of(const Vec3* points, int count, Vec3& lo, Vec3& hi) {
  lo = hi = points[0];
  for (int i = 1; i < count; ++i)
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], points[i][a]);
      hi[a] = std::max(hi[a], points[i][a]);
    }
}

accel::Bvh4 one_leaf(const std::vector<accel::LeafTriangle>& triangles) {
  std::vector<Vec3> points;
  for (const accel::LeafTriangle& t : triangles) points.insert(points.end(), {t.v0, t.v1, t.v2});
  accel::Bvh4 bvh;
  bounds_of(points.data(), static_cast<int>(points.size()), bvh.lower, bvh.upper);
  bvh.triangles = triangles;
  bvh.depth = 1;
  accel::Node4 node;
  node.boxes = box_in_lane_0(bvh.lower, bvh.upper);
  std::fill_n(node.child, intersect::kLanes, accel::kEmptyChild);
  node.child[0] = accel::make_leaf(0, static_cast<int>(triangles.size()));
  bvh.nodes.push_back(node);
  return bvh;
}

std::string text(const Vec3& v) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, "{%a, %a, %a}", static_cast<double>(v.x), static_cast<double>(v.y),
                static_cast<double>(v.z));
  return buffer;
}

std::string text(const RayAndBox& c) {
  char range[64];
  std::snprintf(range, sizeof range, "[%a, %a]", static_cast<double>(c.ray.tmin), static_cast<double>(c.ray.tmax));
  return "ray " + text(c.ray.origin) + " + t " + text(c.ray.direction) + ", t in " + range + "; box " + text(c.lo) +
         " .. " + text(c.hi);
}

}  // namespace ctu::test
