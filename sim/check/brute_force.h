// What a ray meets among all triangles of a scene: asked of each, with no tree in front.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/intersect/ray.h"
#include "tests/oracle/ray_oracle.h"

namespace ctu::sim::check {

/// A triangle that the exact ray meets within [tmin, tmax], or that the binary32 triangle test accepts.
struct Meeting {
  std::uint32_t triangle = 0;  ///< place in the tree's list
  bool exact = false;
  bool accepted = false;
  float t = 0;  ///< of the triangle test, where it accepts
};

class BruteForce {
 public:
  explicit BruteForce(const accel::Bvh4& bvh);

  /// All meetings of a valid ray, equal triangles one after the other. The reference is good until the next call.
  const std::vector<Meeting>& meetings(const intersect::PreparedRay& prepared);

  /// Questions to the oracle so far.
  const oracle::OracleCounts& counts() const { return counts_; }

 private:
  /// Triangles with the same vertices, which are asked once: places [first, last) of `members_`.
  struct Group {
    std::uint32_t first = 0, last = 0;
  };
  void group_equal_triangles();

  const accel::Bvh4& bvh_;
  std::vector<std::uint32_t> members_;  ///< places in the tree's list
  std::vector<Group> groups_;
  std::size_t padded_ = 0;             ///< groups, rounded up to whole vectors
  std::vector<double> coordinate_[3];  ///< by axis: of the groups' first vertices, then second, then third ones
  std::vector<double> distance_;       ///< of a group from the line, as an area; above 0: nothing meets
  std::vector<Meeting> meetings_;
  oracle::OracleCounts counts_;
};

}  // namespace ctu::sim::check
