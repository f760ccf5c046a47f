#include "sim/check/comparison.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "model/base/parallel.h"
#include "sim/check/brute_force.h"
#include "sim/check/naive_test.h"

namespace ctu::sim::check {
namespace {

/// Whose culling and work the table shows: plain, the widest padding of times, and the safe ones.
constexpr std::size_t kShownForms[] = {0, 2, 4, 5};

constexpr Padding kPaddings[] = {{}, {1e-6f, 0}, {1e-4f, 0}, {0, 1e-4f}};
static_assert(std::size(kPaddings) == kNaiveForms);

/// What one form makes of a ray: the triangles that it comes to.
class Visits {
 public:
  explicit Visits(const accel::Bvh4& bvh) : bvh_(bvh), reached_in_(bvh.triangles.size(), 0) {}

  /// `test(node)` gives the lanes hit and passed.
  template <class Test>
  void walk(const Test& test, FormCounts& counts) {
    ++turn_;
    stack_.assign(1, 0);
    while (!stack_.empty()) {
      const accel::ChildRef ref = stack_.back();
      stack_.pop_back();
      if (accel::is_leaf(ref))
        visit_leaf(ref, counts);
      else
        visit_node(ref, test(ref), counts);
    }
  }
  bool reached(std::uint32_t triangle) const { return reached_in_[triangle] == turn_; }

 private:
  void visit_leaf(accel::ChildRef ref, FormCounts& counts) {
    const auto count = static_cast<std::uint32_t>(accel::leaf_count(ref));
    counts.tests += count;
    for (std::uint32_t i = 0; i < count; ++i) reached_in_[accel::leaf_first(ref) + i] = turn_;
  }
  void visit_node(accel::ChildRef ref, LaneSets lanes, FormCounts& counts) {
    ++counts.tests;
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      if ((lanes.hit >> lane & 1) == 0) continue;
      ++counts.box_hits;
      if ((lanes.pass >> lane & 1) != 0)
        stack_.push_back(bvh_.nodes[ref].child[lane]);
      else
        ++counts.culled;
    }
  }

  const accel::Bvh4& bvh_;
  std::uint32_t turn_ = 0;
  std::vector<std::uint32_t> reached_in_;  ///< by triangle: the walk that came to it last
  std::vector<accel::ChildRef> stack_;
};

/// The unit's own node test.
auto safe_test(const reference::NodeTest& test_node, const intersect::PreparedRay& ray) {
  return [&](std::uint32_t node) {
    intersect::SlabTimes times;
    const cull::MaskTestResult result = test_node(ray, node, ray.ray.tmax, times);
    return LaneSets{times.hit, result.pass};
  };
}

ComparisonRow compare_scene(const CheckScene& scene, const cull::MaskTester& comparators) {
  const cull::ProjectionTable& table = *scene.tester->projection_table();
  std::vector<NaiveTest> naive;
  for (const Padding& padding : kPaddings) naive.emplace_back(scene.bvh, scene.masks.masks, table, padding);
  const reference::NodeTest by_table = scene.node_test();
  const reference::NodeTest by_comparators(scene.bvh, &scene.masks.masks, comparators);
  BruteForce brute_force(scene.bvh);
  Visits visits(scene.bvh);
  ComparisonRow row;
  for (const intersect::Ray& ray : scene.hard.rays) {
    ++row.rays;
    const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
    const std::vector<Meeting>& meetings = brute_force.meetings(prepared);
    for (const Meeting& meeting : meetings) row.exact_hits += meeting.exact;
    for (std::size_t form = 0; form < kForms.size(); ++form) {
      FormCounts& counts = row.forms[form];
      if (form < kNaiveForms)
        visits.walk([&](std::uint32_t node) { return naive[form](ray, node); }, counts);
      else
        visits.walk(safe_test(form == kNaiveForms ? by_table : by_comparators, prepared), counts);
      for (const Meeting& meeting : meetings) counts.lost += meeting.exact && !visits.reached(meeting.triangle);
    }
  }
  return row;
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

void print_row(std::string_view name, const std::string& exact_hits, const FormFigures& figures) {
  fmt::print("{:<24}{:>11}", name, exact_hits);
  for (const double lost : figures.lost_per_million) fmt::print("{:>11.1f}", lost);
  for (const std::size_t form : kShownForms) fmt::print("{:>8.2f}", 100 * figures.culled_share[form]);
  for (const std::size_t form : kShownForms) fmt::print("{:>8.2f}", figures.tests_per_ray[form]);
  fmt::print("\n");
}

}  // namespace

ComparisonRow& ComparisonRow::operator+=(const ComparisonRow& other) {
  rays += other.rays;
  exact_hits += other.exact_hits;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    forms[i].lost += other.forms[i].lost;
    forms[i].box_hits += other.forms[i].box_hits;
    forms[i].culled += other.forms[i].culled;
    forms[i].tests += other.forms[i].tests;
  }
  return *this;
}

std::uint64_t ComparisonResult::safe_forms_lost() const {
  std::uint64_t lost = 0;
  for (const ComparisonRow& row : by_generator)
    for (std::size_t form = kNaiveForms; form < kForms.size(); ++form) lost += row.forms[form].lost;
  return lost;
}

ComparisonResult compare_forms(const CampaignOptions& options, const cull::MaskOptions& masks,
                               const std::function<void(std::uint64_t cases)>& progress) {
  const auto started = std::chrono::steady_clock::now();
  const DrawSetup fixed = [&](CaseRandom&) { return CullingSetup{.design = cull::Design::Projection, .masks = masks}; };
  const cull::MaskTester comparators(cull::Design::Comparators, masks);
  TesterCache testers;
  ComparisonResult result;
  result.by_generator.resize(options.generators.size());
  // A round is a scene of every generator, so that no two threads count in one row.
  for (std::uint64_t scene = options.only_scene.value_or(0);; ++scene) {
    parallel_chunks(options.generators.size(), 1, options.threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const SceneNumber number{options.generators[i], scene};
        CaseRandom random = scene_random(options.seed, number);
        result.by_generator[i] += compare_scene(make_scene(options.seed, number, fixed, random, testers), comparators);
      }
    });
    std::uint64_t cases = 0;
    for (const ComparisonRow& row : result.by_generator) cases += row.rays;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (progress) progress(cases);
    const bool used_up =
        options.budget.cases != 0 ? cases >= options.budget.cases : result.seconds >= options.budget.seconds;
    if (used_up || options.only_scene) return result;
  }
}

FormFigures figures_of(const ComparisonRow& row) {
  FormFigures figures;
  for (std::size_t i = 0; i < kForms.size(); ++i) {
    figures.lost_per_million[i] = 1e6 * ratio(row.forms[i].lost, row.exact_hits);
    figures.culled_share[i] = ratio(row.forms[i].culled, row.forms[i].box_hits);
    figures.tests_per_ray[i] = ratio(row.forms[i].tests, row.rays);
  }
  return figures;
}

FormFigures mean_figures(const ComparisonResult& result) {
  FormFigures mean;
  const double weight = 1.0 / static_cast<double>(result.by_generator.size());
  for (const ComparisonRow& row : result.by_generator) {
    const FormFigures figures = figures_of(row);
    for (std::size_t i = 0; i < kForms.size(); ++i) {
      mean.lost_per_million[i] += weight * figures.lost_per_million[i];
      mean.culled_share[i] += weight * figures.culled_share[i];
      mean.tests_per_ray[i] += weight * figures.tests_per_ray[i];
    }
  }
  return mean;
}

void print_comparison(const CampaignOptions& options, const ComparisonResult& result) {
  fmt::print("{:35}{:^66}{:^32}{:^32}\n{:<24}{:>11}", "", "hits lost per million exact hits", "culled, % of box hits",
             "nodes and triangles a ray", "generator", "exact hits");
  for (const std::string_view form : kForms) fmt::print("{:>11}", form);
  for (int group = 0; group < 2; ++group)
    for (const std::size_t form : kShownForms) fmt::print("{:>8}", kForms[form]);
  fmt::print("\n");
  std::uint64_t cases = 0, exact_hits = 0;
  for (std::size_t i = 0; i < result.by_generator.size(); ++i) {
    const ComparisonRow& row = result.by_generator[i];
    print_row(generators()[options.generators[i]].name, std::to_string(row.exact_hits), figures_of(row));
    cases += row.rays;
    exact_hits += row.exact_hits;
  }
  print_row("mean of generators", "", mean_figures(result));
  fmt::print("{} cases, {} exact hits in {:.1f} s on {} threads\n", cases, exact_hits, result.seconds, options.threads);
}

}  // namespace ctu::sim::check
