#include "tests/support/motions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace ctu::test {
namespace {

class Mover {
 public:
  Mover(scene::Mesh& mesh, std::uint64_t seed) : mesh_(mesh), vertices_(mesh.vertices), random_(seed) {
    lower_ = upper_ = vertices_.front();
    for (const Vec3& v : vertices_)
      for (int a = 0; a < 3; ++a) {
        lower_[a] = std::min(lower_[a], v[a]);
        upper_[a] = std::max(upper_[a], v[a]);
      }
  }

  void one_vertex() { shake(any_vertex(), 0.1); }

  void dent() {
    const Vec3 centre = any_vertex();
    const auto distance = [&](const Vec3& v) {
      return std::hypot(static_cast<double>(v.x) - centre.x, static_cast<double>(v.y) - centre.y,
                        static_cast<double>(v.z) - centre.z);
    };
    std::vector<std::size_t> nearest(vertices_.size());
    for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = i;
    const auto count = static_cast<std::ptrdiff_t>(nearest.size() / 100 + 1);
    std::partial_sort(nearest.begin(), nearest.begin() + count, nearest.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(distance(vertices_[a]), a) < std::pair(distance(vertices_[b]), b);
    });
    for (auto i = nearest.begin(); i != nearest.begin() + count; ++i)
      for (int a = 0; a < 3; ++a) vertices_[*i][a] = rounded(0.95 * vertices_[*i][a] + 0.05 * middle(a));
  }

  void scattered() {
    for (Vec3& v : vertices_)
      if (chance(5)) shake(v, 0.02);
  }

  void twist() {
    const double extent = std::max(static_cast<double>(upper_.z) - lower_.z, 1e-300);
    for (Vec3& v : vertices_) {
      const double angle = (static_cast<double>(v.z) - lower_.z) / extent;
      const double x = v.x - middle(0), y = v.y - middle(1);
      v.x = rounded(middle(0) + std::cos(angle) * x - std::sin(angle) * y);
      v.y = rounded(middle(1) + std::sin(angle) * x + std::cos(angle) * y);
    }
  }

  void degenerate() {
    for (const auto& corners : mesh_.triangles) {
      if (chance(3)) vertices_[corners[1]] = vertices_[corners[2]] = vertices_[corners[0]];
      if (chance(3)) vertices_[corners[2]] = vertices_[corners[1]];
    }
  }

  void flatten() {
    for (Vec3& v : vertices_) v.y = rounded(middle(1));
  }

  void far_away() { any_vertex().x = 1e30f; }

  void reorder() {
    for (Vec3& v : vertices_)
      if (chance(10)) std::swap(v, any_vertex());
  }

  void signs() {
    for (Vec3& v : vertices_)
      for (int a = 0; a < 3; ++a)
        if (v[a] == 0) v[a] = -v[a];
  }

 private:
  /// Never infinite: a mesh may fill the whole range of binary32.
  static float rounded(double x) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -kMost, kMost));
  }
  double middle(int axis) const { return 0.5 * (static_cast<double>(lower_[axis]) + upper_[axis]); }
  Vec3& any_vertex() { return vertices_[random_() % vertices_.size()]; }
  bool chance(unsigned percent) { return random_() % 100 < percent; }
  void shake(Vec3& v, double part) {
    for (int a = 0; a < 3; ++a) {
      const double unit = static_cast<double>(random_() >> 11) * 0x1p-52 - 1;
      v[a] = rounded(v[a] + part * unit * (static_cast<double>(upper_[a]) - lower_[a]));
    }
  }

  scene::Mesh& mesh_;
  std::vector<Vec3>& vertices_;
  std::mt19937_64 random_;
  Vec3 lower_, upper_;
};

}  // namespace

std::string to_string(Motion motion) {
  switch (motion) {
    case Motion::Nothing:
      return "nothing";
    case Motion::OneVertex:
      return "one vertex";
    case Motion::Dent:
      return "dent";
    case Motion::Scattered:
      return "scattered";
    case Motion::Twist:
      return "twist";
    case Motion::Degenerate:
      return "degenerate";
    case Motion::Flatten:
      return "flatten";
    case Motion::FarAway:
      return "far away";
    case Motion::Reorder:
      return "reorder";
    case Motion::Signs:
      return "signs";
  }
  return "?";
}

scene::Mesh moved(scene::Mesh mesh, Motion motion, std::uint64_t seed) {
  Mover mover(mesh, seed);
  switch (motion) {
    case Motion::Nothing:
      break;
    case Motion::OneVertex:
      mover.one_vertex();
      break;
    case Motion::Dent:
      mover.dent();
      break;
    case Motion::Scattered:
      mover.scattered();
      break;
    case Motion::Twist:
      mover.twist();
      break;
    case Motion::Degenerate:
      mover.degenerate();
      break;
    case Motion::Flatten:
      mover.flatten();
      break;
    case Motion::FarAway:
      mover.far_away();
      break;
    case Motion::Reorder:
      mover.reorder();
      break;
    case Motion::Signs:
      mover.signs();
      break;
  }
  return mesh;
}

}  // namespace ctu::test
