#include "sim/sweep/expand.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/config_file.h"

namespace ctu::sweep {
namespace {

/// Whether every line fits; a key that has no value here fits nothing.
bool fits(const Exclusion& exclusion, const Settings& settings) {
  return std::all_of(exclusion.begin(), exclusion.end(), [&](const Condition& condition) {
    const auto at = std::find_if(settings.begin(), settings.end(),
                                 [&](const Setting& setting) { return setting.key == condition.key; });
    return at != settings.end() && condition.fits(at->value);
  });
}

}  // namespace

Settings Expander::settings(const Candidate& candidate) const {
  Settings settings = space_.groups[candidate[0]].settings;
  for (std::size_t a = 0; a < space_.axes.size(); ++a) {
    const Axis& axis = space_.axes[a];
    for (std::size_t k = 0; k < axis.keys.size(); ++k)
      settings.push_back({axis.keys[k], axis.choices[candidate[a + 1]][k]});
  }
  return settings;
}

std::optional<pipeline::UnitConfig> Expander::config(const Candidate& candidate, std::string* why) const {
  std::vector<std::string> sets = space_.sets;
  for (std::size_t a = 0; a < space_.axes.size(); ++a) {
    const Axis& axis = space_.axes[a];
    for (std::size_t k = 0; k < axis.keys.size(); ++k)
      sets.push_back(axis.keys[k] + "=" + axis.choices[candidate[a + 1]][k]);
  }
  try {
    return sim::load_config(space_.config_path, sets);
  } catch (const Error& error) {
    if (why != nullptr) *why = fmt::format("{}: {}", error.where(), error.problem());
    return std::nullopt;
  }
}

std::vector<std::size_t> Expander::traces(const Candidate& candidate) const {
  std::vector<std::size_t> left;
  Settings said = settings(candidate);
  for (const std::size_t t : space_.groups[candidate[0]].traces) {
    said.push_back({"scene", space_.traces[t].scene});
    const bool excluded = std::any_of(space_.exclusions.begin(), space_.exclusions.end(),
                                      [&](const Exclusion& exclusion) { return fits(exclusion, said); });
    if (!excluded) left.push_back(t);
    said.pop_back();
  }
  return left;
}

bool Expander::accepts(const Candidate& candidate) const {
  return !traces(candidate).empty() && config(candidate).has_value();
}

std::vector<Point> Expander::points(const Candidate& candidate, const std::vector<TraceFacts>& facts) const {
  std::vector<Point> points;
  const auto config = this->config(candidate);
  if (!config) return points;
  Point point;
  point.engine = space_.engine;
  point.first_ray = space_.first_ray;
  point.rays = space_.rays;
  point.sets = sets_of(*config);
  point.config_hash = sim::config_hash(*config);
  point.design = cull::to_string(config->mask_test.design);
  const std::vector<std::string> swept = space_.swept_keys();
  for (const Setting& setting : settings(candidate))
    if (std::find(swept.begin(), swept.end(), setting.key) != swept.end()) point.settings.push_back(setting);
  for (const std::size_t t : traces(candidate)) {
    point.trace = facts[t];
    point.id = point_id(point);
    points.push_back(point);
  }
  return points;
}

GridCount walk_grid(const Space& space) {
  constexpr std::uint64_t kMostCandidates = 10000000;
  const CandidateSpace candidates(space);
  const Expander expander(space);
  GridCount grid;
  grid.candidates = candidates.count();
  if (grid.candidates > kMostCandidates)
    throw Error(space.path, fmt::format("a grid of more than {} configurations", kMostCandidates),
                "take fewer values, or write [search] with mode = \"random\" and points = 1000");
  for (std::uint64_t i = 0; i < grid.candidates; ++i) {
    Candidate candidate = candidates.at(i);
    std::string why;
    if (expander.traces(candidate).empty()) {
      ++grid.excluded;
    } else if (!expander.config(candidate, &why)) {
      ++grid.refused;
      if (grid.first_refusal.empty()) grid.first_refusal = why;
    } else {
      grid.accepted.push_back(std::move(candidate));
    }
  }
  return grid;
}

}  // namespace ctu::sweep
