// `ctusim compression`: what replacing object masks by the entries of a LUT costs, for each way to choose the entries.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/cull/compress.h"
#include "model/cull/distinct_masks.h"
#include "model/cull/mask_selection.h"
#include "model/cull/requirement_luts.h"
#include "model/cull/sah_masked.h"
#include "model/reference/traversal.h"
#include "sim/commands.h"
#include "sim/progress.h"
#include "sim/ray_survey.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "sim/stopwatch.h"
#include "traces/ray_generator.h"

namespace ctu::sim {
namespace {

using cull::Selection;

constexpr int kDefaultEntries = 256;
constexpr std::size_t kBruteForceSearches = 100000;  ///< timed, and scaled up to all children

/// A table, or two, and what came of it.
struct Row {
  std::string name;
  int entries = 0;
  cull::ObjectMasks masks;
  double select_seconds = 0;
  double brute_seconds = 0, search_seconds = 0;  ///< for all children; 0: not measured
  double sah = 0;
  std::uint64_t intersections = 0;
};

struct World {
  const scene::Scene& scene;
  const traces::RecordOptions& options;
  accel::Bvh4 bvh;
  cull::ObjectMasks masks;
};

std::vector<std::size_t> children_of(const accel::Bvh4& bvh) {
  std::vector<std::size_t> children;
  for (std::size_t child = 0; child < bvh.nodes.size() * intersect::kLanes; ++child)
    if (bvh.nodes[child / intersect::kLanes].child[child % intersect::kLanes] != accel::kEmptyChild)
      children.push_back(child);
  return children;
}

/// Processor seconds of `find(mask)` for every `stride`th child, scaled up to all.
template <class Find>
double time_search(const World& world, std::size_t stride, Find&& find) {
  const std::vector<std::size_t> children = children_of(world.bvh);
  std::uint64_t sum = 0;
  const ThreadStopwatch watch;
  for (std::size_t i = 0; i < children.size(); i += stride)
    sum += static_cast<std::uint64_t>(find(world.masks.bits.data() + children[i] * std::size_t(world.masks.words)));
  const double seconds = watch.seconds() * double(stride);
  return sum == ~std::uint64_t{0} ? 0 : seconds;  // the sum is used, so the searches are made
}

void time_searches(const World& world, const cull::CompressionLut& lut, Row& row) {
  const std::size_t stride = std::max<std::size_t>(1, children_of(world.bvh).size() / kBruteForceSearches);
  row.brute_seconds = time_search(world, stride, [&](const std::uint64_t* mask) { return lut.tightest(mask); });
  const cull::RequirementLuts search(lut);
  row.search_seconds = time_search(world, 1, [&](const std::uint64_t* mask) { return search.find(mask); });
}

/// One table, chosen with the given weights.
Row choose(const World& world, const std::string& name, Selection selection, const cull::ChildWeights& weights) {
  Row row;
  row.name = name;
  const ThreadStopwatch watch;
  const cull::CompressionLut lut = cull::select_masks(world.masks, weights, selection, world.options.masks.entries);
  row.select_seconds = watch.seconds();
  row.entries = lut.entries();
  row.masks = cull::replace_masks(world.bvh, world.masks, lut, world.options.threads);
  time_searches(world, lut, row);
  return row;
}

/// How often a pilot's rays meet each child's box, times what a child that passes costs.
cull::ChildWeights ray_weights(const World& world) {
  traces::RayOptions rays = world.options.rays;
  rays.seed += 1;  // other rays than those that judge
  const cull::MaskTester none(cull::Design::None, world.options.masks);
  const cull::MaskTester culling(cull::Design::Comparators, world.options.masks);
  const reference::Traversal plain(world.bvh, nullptr, none), culled(world.bvh, &world.masks, culling);
  const traces::RayGenerator generator(world.scene, rays);
  std::vector<intersect::Ray> pilot;
  std::vector<intersect::Hit> hits;
  generator.generate(
      0, generator.paths(), [&](const intersect::Ray& ray, bool) { return plain.trace(ray); }, pilot, hits);
  reference::StepList steps;
  for (const intersect::Ray& ray : pilot) culled.trace(ray, &steps);
  cull::ChildWeights weights(world.bvh.nodes.size() * intersect::kLanes);
  for (const reference::Step& step : steps.steps) {
    if (step.is_leaf()) continue;
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      if ((step.box_hits() >> lane & 1) == 0) continue;
      const accel::ChildRef child = world.bvh.nodes[step.ref].child[lane];
      weights[std::size_t{step.ref} * intersect::kLanes + std::size_t(lane)] +=
          accel::is_leaf(child) ? accel::leaf_count(child) : 1;
    }
  }
  return weights;
}

/// Leaves and inner children with a table of all entries each: a node knows which a child is, so the index grows by
/// nothing.
Row choose_by_kind(const World& world) {
  Row row;
  row.name = "refined, leaves and inner children apart";
  row.masks = world.masks;
  const cull::ChildWeights weights = cull::sah_weights(world.bvh);
  for (const bool leaves : {false, true}) {
    cull::ChildWeights own = weights;
    const auto is_own = [&](std::size_t child) {
      return accel::is_leaf(world.bvh.nodes[child / intersect::kLanes].child[child % intersect::kLanes]) == leaves;
    };
    for (std::size_t child = 0; child < own.size(); ++child)
      if (!is_own(child)) own[child] = 0;
    const Row one = choose(world, "", Selection::Refined, own);
    const auto words = std::ptrdiff_t{world.masks.words};
    for (std::size_t child = 0; child < own.size(); ++child)
      if (is_own(child)) {
        const auto first = one.masks.bits.begin() + static_cast<std::ptrdiff_t>(child) * words;
        std::copy(first, first + words, row.masks.bits.begin() + static_cast<std::ptrdiff_t>(child) * words);
      }
    row.entries += one.entries;
    row.select_seconds += one.select_seconds;
  }
  return row;
}

std::vector<Row> choose_all(const World& world, bool ideas) {
  std::vector<Row> rows;
  for (const Selection selection : {Selection::TopPerNode, Selection::TopSummed, Selection::Refined})
    rows.push_back(
        choose(world, std::string(to_string(selection)), selection, cull::selection_weights(world.bvh, selection)));
  if (!ideas) return rows;
  rows.push_back(choose(world, "top-summed, Eq. 2 weights", Selection::TopSummed, cull::sah_weights(world.bvh)));
  rows.push_back(choose(world, "refined, ray weights", Selection::Refined, ray_weights(world)));
  rows.push_back(choose_by_kind(world));
  return rows;
}

/// Fills in the rows' costs; returns the intersections without culling and with the masks as they are.
std::pair<std::uint64_t, std::uint64_t> judge(const World& world, const std::string& name, std::vector<Row>& rows) {
  const cull::MaskTester none(cull::Design::None, world.options.masks);
  const cull::MaskTester culling(cull::Design::MaskLut, world.options.masks);
  std::vector<Contender> contenders{{&none, nullptr, false}, {&culling, &world.masks, false}};
  for (const Row& row : rows) contenders.push_back({&culling, &row.masks, false});
  Progress bar(name, 0, "paths");
  const RaySurvey survey = survey_rays(world.scene, world.bvh, contenders, {world.options.rays, world.options.threads},
                                       [&](std::uint64_t done) { bar.update(done); });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].sah = cull::sah_masked(world.bvh, rows[i].masks);
    rows[i].intersections = survey.contenders[i + 2].counts.intersections();
  }
  return {survey.contenders[0].counts.intersections(), survey.contenders[1].counts.intersections()};
}

double percent(double part, double whole) { return whole == 0 ? 0 : 100 * part / whole; }

void print_header(bool markdown) {
  if (markdown)
    fmt::print(
        "| scene | R | nodes | distinct masks | selection | entries | Eq. 2 | share of loss | intersections | share of "
        "loss | selection s | s per million nodes | brute force ms | Algorithm 3 ms |\n"
        "| --- | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  else
    fmt::print("{:<20}{:>2}{:>9}{:>10} {:<42}{:>8}{:>10}{:>8}{:>11}{:>8}{:>10}{:>9}{:>10}{:>10}\n", "scene", "R",
               "nodes", "distinct", "selection", "entries", "Eq. 2", "share", "inters.", "share", "select s",
               "s/Mnodes", "brute ms", "Alg. 3 ms");
}

/// Losses are against the masks as they are; shares are of the first row's, the paper's selection.
void print_rows(const std::string& name, const World& world, const std::vector<Row>& rows, std::uint64_t without,
                std::uint64_t with, bool markdown) {
  const double sah = cull::sah_masked(world.bvh, world.masks);
  const std::size_t distinct = cull::distinct_masks(world.masks, cull::area_weights(world.bvh)).size();
  const auto nodes = double(world.bvh.nodes.size());
  const auto print = [&](const Row& row, double sah_share, double share) {
    const double sah_loss = percent(row.sah - sah, sah), work = percent(double(row.intersections), double(without));
    const double relative_seconds = 1e6 * row.select_seconds / nodes;
    const double brute_ms = 1e3 * row.brute_seconds, search_ms = 1e3 * row.search_seconds;
    if (markdown)
      fmt::print(
          "| {} | {} | {} | {} | {} | {} | +{:.2f} % | {:.1f} % | {:.2f} % | {:.1f} % | {:.3f} | {:.2f} | {:.1f} | "
          "{:.1f} |\n",
          name, world.masks.resolution, world.bvh.nodes.size(), distinct, row.name, row.entries, sah_loss, sah_share,
          work, share, row.select_seconds, relative_seconds, brute_ms, search_ms);
    else
      fmt::print(
          "{:<20}{:>2}{:>9}{:>10} {:<42}{:>8}{:>8.2f} %{:>6.1f} %{:>9.2f} %{:>6.1f} "
          "%{:>10.3f}{:>9.2f}{:>10.1f}{:>10.1f}\n",
          name, world.masks.resolution, world.bvh.nodes.size(), distinct, row.name, row.entries, sah_loss, sah_share,
          work, share, row.select_seconds, relative_seconds, brute_ms, search_ms);
  };
  Row uncompressed;
  uncompressed.name = "masks as they are";
  uncompressed.sah = sah;
  uncompressed.intersections = with;
  print(uncompressed, 0, 0);
  for (const Row& row : rows)
    print(row, percent(row.sah - sah, rows[0].sah - sah),
          percent(double(row.intersections) - double(with), double(rows[0].intersections) - double(with)));
  std::fflush(stdout);
}

}  // namespace

int compression_command(const CompressionArgs& args) {
  SceneArgs with_entries = args.scene;
  if (!with_entries.compress) with_entries.compress = kDefaultEntries;
  const traces::RecordOptions options = record_options(with_entries);
  print_header(args.markdown);
  for (const ListedScene& listed : listed_scenes(args.scene)) {
    const std::optional<scene::Scene> scene = load_listed(args.scene, listed);
    if (!scene) continue;
    World world{*scene, options, accel::build(scene->mesh, options.build), {}};
    world.masks = cull::build_object_masks(world.bvh, options.masks, options.threads);
    std::vector<Row> rows = choose_all(world, args.ideas);
    const auto [without, with] = judge(world, listed.name, rows);
    print_rows(listed.name, world, rows, without, with, args.markdown);
  }
  return 0;
}

}  // namespace ctu::sim
