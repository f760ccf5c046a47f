// The splitting plane facing heuristic (SPFH): a plane that the rays run along puts the children side by side for them,
// so that few rays visit both; a plane that faces the rays puts one behind the other, and every ray visits both.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/accel/split_heuristic.h"
#include "model/influence/area.h"

namespace ctu::influence {

/// facing(k) = |v_k| / (|v_x| + |v_y| + |v_z|): 1 where the rays run straight at planes across axis k, 0 where they run
/// along them. All 0 for the null vector.
inline std::array<double, 3> facing(double x, double y, double z) {
  const double sum = std::fabs(x) + std::fabs(y) + std::fabs(z);
  if (!(sum > 0)) return {};
  return {std::fabs(x) / sum, std::fabs(y) / sum, std::fabs(z) / sum};
}

/// What decides about an orientation of the splitting plane. The chances of the children, over that of the parent, are
/// 1 for two that share it out and 2 for two that every ray visits.
struct FacingThresholds {
  double facing = 0.4;      ///< planes that face the rays more are hopeless
  double acceptable = 1.3;  ///< children above this are hopeless
  double excellent = 0.9;   ///< children at or below this are good enough: no other orientation is tried
};
/// The stricter ones that the finished paper prefers.
inline constexpr FacingThresholds kStrictThresholds{0.4, 1.1, 0.7};

/// Axes as model/accel/split_heuristic.h has them: least facing first, each with the verdict good enough (stop), normal
/// (the best of them wins) or hopeless; where all are hopeless, the longest axis.
class LeastFacingAxes {
 public:
  /// For boxes in coordinates multiplied by `scale`.
  LeastFacingAxes(const InfluenceArea& area, double scale, const FacingThresholds& thresholds)
      : converges_(area.kind == AreaKind::Point), thresholds_(thresholds) {
    for (int axis = 0; axis < 3; ++axis) {
      direction_[axis] = area.axes[2][axis];
      focus2_[axis] = 2 * scale * area.origin[axis];
    }
  }

  template <class CutOn>
  accel::Cut choose(const accel::Box3& box, float chance, CutOn&& cut_on) const {
    const std::array<double, 3> faces = facing_of(box);
    std::array<int, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return faces[a] < faces[b]; });
    accel::Cut best;
    for (const int axis : order) {
      if (faces[axis] > thresholds_.facing) break;
      const accel::Cut cut = cut_on(axis);
      if (cut.axis < 0) continue;
      if (cut.children <= thresholds_.excellent * chance) return cut;
      if (cut.children <= thresholds_.acceptable * chance) best.offer(cut);
    }
    return best.axis >= 0 ? best : accel::LongestAxis{}.choose(box, chance, cut_on);
  }

 private:
  /// By the ray through the middle of the box.
  std::array<double, 3> facing_of(const accel::Box3& box) const {
    if (!converges_) return facing(direction_[0], direction_[1], direction_[2]);
    alignas(16) float centre2[4];
    _mm_store_ps(centre2, _mm_add_ps(box.lower, box.upper));
    return facing(centre2[0] - focus2_[0], centre2[1] - focus2_[1], centre2[2] - focus2_[2]);
  }

  bool converges_;
  FacingThresholds thresholds_;
  std::array<double, 3> direction_, focus2_;
};

}  // namespace ctu::influence
