#include "sim/metamorph/transformation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace ctu::sim::metamorph {
namespace {

using intersect::Ray;

// A difference of two coordinates is at least a unit in the last place of the smaller one, 2^-23 of it; a product of
// it with a reciprocal of at least 1 must be a normal number for its bits not to depend on the scale.
constexpr int kLeastExponent = -126 + 24;
// Times are up to twice the largest coordinate over a component of the direction; what is left is for that component.
constexpr int kMostExponent = 90;
constexpr int kPowers[] = {-40, -1, 7, 40};

Transformation power_of_two(int exponent) {
  return {fmt::format("x 2^{}", exponent), Kind::Power, std::ldexp(1.0, exponent), {}, {0, 1, 2}, {1, 1, 1}};
}

void add_powers(const Magnitudes& scene, TransformationList& list) {
  const int least = scene.smallest == 0 ? kPowers[0] : kLeastExponent - std::ilogb(scene.smallest);
  const int most = scene.largest == 0 ? kPowers[3] : kMostExponent - std::ilogb(scene.largest);
  std::vector<int> taken{0};
  for (const int wanted : kPowers) {
    const int exponent = wanted < 0 ? std::max(wanted, std::min(least, 0)) : std::min(wanted, std::max(most, 0));
    if (exponent != wanted)
      list.left_out.push_back(fmt::format("x 2^{}: coordinates from {:.1e} to {:.1e} allow 2^{}", wanted,
                                          scene.smallest, scene.largest, exponent));
    if (std::find(taken.begin(), taken.end(), exponent) != taken.end()) continue;
    taken.push_back(exponent);
    list.transformations.push_back(power_of_two(exponent));
  }
}

bool stays_finite(const Magnitudes& scene, double factor, double offset) {
  return scene.largest * factor + offset <= 0.25 * std::numeric_limits<float>::max();
}

void add_factors(const Magnitudes& scene, TransformationList& list) {
  const std::pair<const char*, double> factors[] = {{"x 1/3", 1.0 / 3}, {"x 1e-7", 1e-7}, {"x 1e7", 1e7}};
  for (const auto& [name, factor] : factors) {
    if (stays_finite(scene, factor, 0))
      list.transformations.push_back({name, Kind::Factor, factor, {}, {0, 1, 2}, {1, 1, 1}});
    else
      list.left_out.push_back(fmt::format("{}: coordinates up to {:.1e} would overflow", name, scene.largest));
  }
}

void add_translations(const Magnitudes& scene, TransformationList& list) {
  for (const double sizes : {1.0, 1e3, 1e5, 1e7}) {
    const std::string name = fmt::format("moved by {:g} sizes", sizes);
    const double by = sizes * scene.size;
    if (stays_finite(scene, 1, by))
      list.transformations.push_back({name, Kind::Translation, 1, {by, -0.7 * by, 0.4 * by}, {0, 1, 2}, {1, 1, 1}});
    else
      list.left_out.push_back(fmt::format("{}: coordinates would overflow", name));
  }
}

constexpr std::array<std::array<int, 3>, 6> kPermutations{
    {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};

Transformation symmetry(const std::array<int, 3>& from, unsigned mirrored) {
  Transformation t;
  t.from = from;
  std::string order, axes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    order += "xyz"[from[a]];
    if ((mirrored >> axis & 1) == 0) continue;
    t.sign[a] = -1;
    axes += "xyz"[axis];
  }
  const bool permuted = from != kPermutations[0];
  if (permuted) t.name = "axes " + order, t.kind = Kind::Permutation;
  if (mirrored != 0) t.name = (permuted ? t.name + ", " : "") + "mirrored in " + axes, t.kind = Kind::Mirror;
  return t;
}

class Range {
 public:
  void add(double x) {
    x = std::fabs(x);
    if (x == 0 || !std::isfinite(x)) return;
    smallest_ = smallest_ == 0 ? x : std::min(smallest_, x);
    largest_ = std::max(largest_, x);
  }
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }

 private:
  double smallest_ = 0, largest_ = 0;
};

}  // namespace

Vec3 Transformation::point(const Vec3& p) const {
  const double offsets[3] = {offset.x, offset.y, offset.z};
  Vec3 image;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double scaled = sign[a] * factor * p[from[a]];
    image[axis] = static_cast<float>(offsets[axis] == 0 ? scaled : scaled + offsets[axis]);  // a zero keeps its sign
  }
  return image;
}

Vec3 Transformation::direction(const Vec3& d) const {
  Vec3 image;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    image[axis] = static_cast<float>(sign[a]) * d[from[a]];
  }
  return image;
}

Ray Transformation::operator()(const Ray& ray) const {
  return {point(ray.origin), time(ray.tmin), direction(ray.direction), time(ray.tmax), ray.kind};
}

scene::Mesh Transformation::operator()(scene::Mesh mesh) const {
  for (Vec3& vertex : mesh.vertices) vertex = point(vertex);
  return mesh;
}

Magnitudes magnitudes(const scene::Mesh& mesh, const std::vector<Ray>& rays) {
  Range range;
  Vec3 lower = mesh.vertices[mesh.triangles.front()[0]], upper = lower;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      const Vec3& v = mesh.vertices[vertex];
      range.add(v);
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], v[axis]);
        upper[axis] = std::max(upper[axis], v[axis]);
      }
    }
  for (const Ray& ray : rays) {
    range.add(ray.origin);
    range.add(ray.tmin);
    range.add(ray.tmax);
  }
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) size = std::max(size, static_cast<double>(upper[axis]) - lower[axis]);
  return {range.smallest(), range.largest(), size};
}

bool keeps_bits(const Transformation& transformation, const Ray& ray, const Magnitudes& scene) {
  double smallest = HUGE_VAL, largest = 0;
  int with_largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::fabs(ray.direction[axis]);
    if (d != 0) smallest = std::min(smallest, d);
    with_largest = d > largest ? 1 : with_largest + (d == largest ? 1 : 0);
    largest = std::max(largest, d);
  }
  if (transformation.kind == Kind::Power)
    return 2 * scene.largest / smallest * std::max(1.0, transformation.factor) < 0x1p126;
  return with_largest == 1;
}

TransformationList transformations(const std::vector<Kind>& kinds, const Magnitudes& scene) {
  TransformationList list;
  for (const Kind kind : kinds) {
    if (kind == Kind::Identity) list.transformations.emplace_back();
    if (kind == Kind::Power) add_powers(scene, list);
    if (kind == Kind::Factor) add_factors(scene, list);
    if (kind == Kind::Translation) add_translations(scene, list);
    if (kind == Kind::Permutation)
      for (std::size_t p = 1; p < kPermutations.size(); ++p)
        list.transformations.push_back(symmetry(kPermutations[p], 0));
    if (kind == Kind::Mirror)
      for (unsigned mirrored = 1; mirrored < 8; ++mirrored)
        list.transformations.push_back(symmetry(kPermutations[0], mirrored));
  }
  return list;
}

std::vector<Transformation> axis_symmetries() {
  std::vector<Transformation> all;
  for (const auto& from : kPermutations)
    for (unsigned mirrored = 0; mirrored < 8; ++mirrored) all.push_back(symmetry(from, mirrored));
  return all;
}

}  // namespace ctu::sim::metamorph
