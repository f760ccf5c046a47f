// Whether the answers of an execution account for every true hit.
//
// A primitive that the exact ray meets within [tmin, tmax] is lost where a test in front of it rejects the ray's first
// interval, or where the binary32 triangle test accepts it at some t and the answer is no hit or, for a closest-hit
// ray, one beyond t although the exact ray meets the primitive no later than the answer.
//
// Counted apart: what only the triangle test declines; and what it places before an answer that the exact ray comes to
// first. Its t is rounded at the size of the coordinates, so two hits may change places; a box may rightly be
// rejected behind a hit that lies in front of it.
#pragma once

#include <string>
#include <vector>

#include "sim/check/brute_force.h"
#include "sim/check/check_scene.h"
#include "sim/check/leaf_paths.h"
#include "sim/check/tally.h"

namespace ctu::sim::check {

class Judge {
 public:
  explicit Judge(const CheckScene& scene);

  /// Judges one ray's answer and counts it. Empty when nothing is wrong, else what, for people.
  std::string judge(const intersect::Ray& ray, const intersect::Hit& answer, Tally& tally);

  /// The hit that brute force gives among the triangles that the ray meets exactly.
  intersect::Hit true_hit(const intersect::Ray& ray);

  /// What was counted over all rays: lanes and the oracle's work.
  void finish(Tally& tally) const;

 private:
  bool accounts_for(const intersect::Ray& ray, const intersect::Hit& answer, const Meeting& meeting) const;
  bool is_met_by(const intersect::Ray& ray, float t, std::uint32_t triangle) const;
  bool is_some_triangles(const intersect::PreparedRay& ray, const intersect::Hit& answer,
                         const std::vector<Meeting>& meetings) const;

  const CheckScene& scene_;
  BruteForce brute_force_;
  PathCheck path_;
};

}  // namespace ctu::sim::check
