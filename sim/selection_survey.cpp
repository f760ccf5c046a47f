#include "sim/selection_survey.h"

#include <algorithm>

#include "sim/hit_judge.h"

namespace ctu::sim {
namespace {

using intersect::Hit;
using intersect::Ray;

bool found(const Hit& hit) { return hit.primitive != intersect::kNoPrimitive; }

}  // namespace

double SelectionSurvey::selecting_cost() const {
  const std::uint64_t work = record.local_counts().intersections() + record.global_counts().intersections();
  return double(work) / double(std::max<std::uint64_t>(record.rays, 1));
}

SelectionSurvey survey_selection(const scene::Mesh& mesh, const influence::TreeSet& trees, std::span<const Ray> rays) {
  SelectionSurvey survey;
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal global(trees.global(), nullptr, no_culling);
  const reference::SelectingTraversal selecting(trees);
  const HitJudge judge(mesh);
  reference::StepList alone;
  for (const Ray& ray : rays) {
    Ray closest = ray;
    closest.kind = intersect::RayKind::ClosestHit;
    const Hit as_is = global.trace(ray, &alone), selected = selecting.trace(ray, &survey.record);
    const Hit without = global.trace(closest), with = selecting.trace(closest);
    const bool other_finding = found(as_is) != found(selected), other_hit = !same_bits(without, with);
    if (!other_finding && !other_hit) continue;
    ++survey.changed;
    const bool lost = (other_hit && judge.judge(closest, without, with) == Verdict::Lost) ||
                      (other_finding && judge.judge(ray, as_is, selected) == Verdict::Lost);
    survey.lost += lost ? 1 : 0;
  }
  survey.alone = reference::count_steps(alone, 0, alone.rays());
  return survey;
}

}  // namespace ctu::sim
