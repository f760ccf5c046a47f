#include "sim/sweep/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/sweep/nsga2.h"
#include "sim/sweep/row.h"
#include "sim/sweep/stop_signal.h"

namespace ctu::sweep {
namespace {

using nlohmann::ordered_json;

constexpr std::uint32_t kRandomStream = 3;  // nsga2.cpp has others

/// A column, and whether more of it is better.
struct Objective {
  std::string column;
  bool more = false;
};

std::vector<Objective> objectives_of(const Space& space) {
  std::vector<Objective> objectives;
  for (const std::string& text : space.search.objectives) {
    const bool more = text.rfind("max:", 0) == 0;
    objectives.push_back({more ? text.substr(4) : text, more});
  }
  return objectives;
}

class Judge {
 public:
  explicit Judge(SweepRun& run) : run_(run), objectives_(objectives_of(run.space())) {}

  /// Runs them; nothing when stopped.
  std::vector<Judged> judge(const std::vector<Candidate>& candidates) {
    run_.run(candidates);
    std::vector<Judged> judged;
    if (StopSignal::received()) return judged;
    for (const Candidate& candidate : candidates) judged.push_back({candidate, objectives_of_candidate(candidate)});
    return judged;
  }
  const std::vector<Objective>& objectives() const { return objectives_; }

 private:
  std::optional<Objectives> objectives_of_candidate(const Candidate& candidate) const {
    std::vector<ordered_json> rows;
    for (const Point& point : run_.points_of(candidate)) {
      const auto line = run_.results().line_of.find(point.id);
      if (line == run_.results().line_of.end() || !is_right_line(line->second)) return std::nullopt;
      rows.push_back(joined_row(point, line->second));
    }
    if (rows.empty()) return std::nullopt;
    Objectives values;
    for (const Objective& objective : objectives_) {
      double logarithms = 0;
      for (const ordered_json& row : rows) {
        const auto cell = row.find(objective.column);
        if (cell == row.end() || !cell->is_number()) return std::nullopt;
        logarithms += std::log(cell->get<double>());
      }
      const double mean = std::exp(logarithms / static_cast<double>(rows.size()));
      values.push_back(objective.more ? -mean : mean);
    }
    return values;
  }

  SweepRun& run_;
  std::vector<Objective> objectives_;
};

/// Those with a result on no other's front but their own.
std::vector<Judged> front_of(const std::vector<Judged>& all) {
  std::vector<Judged> with_result;
  std::vector<Objectives> points;
  for (const Judged& one : all)
    if (one.objectives) {
      with_result.push_back(one);
      points.push_back(*one.objectives);
    }
  std::vector<Judged> front;
  for (const std::size_t i : pareto_front(points)) front.push_back(with_result[i]);
  std::sort(front.begin(), front.end(), [](const Judged& a, const Judged& b) { return a.objectives < b.objectives; });
  return front;
}

/// Each objective in shares of the range that both searches have seen: of its logarithm where every value has one, for
/// cycles and bits of one space span orders of magnitude.
class Scale {
 public:
  Scale(const std::vector<Judged>& a, const std::vector<Judged>& b, std::size_t objectives)
      : logarithmic_(objectives, true),
        low_(objectives, std::numeric_limits<double>::infinity()),
        high_(objectives, -std::numeric_limits<double>::infinity()) {
    each(a, b, [&](std::size_t i, double value) {
      if (value <= 0) logarithmic_[i] = false;
    });
    each(a, b, [&](std::size_t i, double value) {
      low_[i] = std::min(low_[i], scaled(i, value));
      high_[i] = std::max(high_[i], scaled(i, value));
    });
  }
  /// Of the box from the best to a tenth beyond the worst of each objective: 0 to 1.
  double covered(const std::vector<Judged>& front) const {
    constexpr double kBeyond = 1.1;
    std::vector<Objectives> points;
    for (const Judged& one : front) {
      Objectives shares;
      for (std::size_t i = 0; i < low_.size(); ++i)
        shares.push_back(high_[i] > low_[i] ? (scaled(i, (*one.objectives)[i]) - low_[i]) / (high_[i] - low_[i]) : 0);
      points.push_back(shares);
    }
    return hypervolume(points, Objectives(low_.size(), kBeyond)) / std::pow(kBeyond, double(low_.size()));
  }

 private:
  template <class Visit>
  static void each(const std::vector<Judged>& a, const std::vector<Judged>& b, Visit&& visit) {
    for (const auto* all : {&a, &b})
      for (const Judged& one : *all)
        for (std::size_t i = 0; one.objectives && i < one.objectives->size(); ++i) visit(i, (*one.objectives)[i]);
  }
  double scaled(std::size_t i, double value) const { return logarithmic_[i] ? std::log(value) : value; }

  std::vector<bool> logarithmic_;
  Objectives low_, high_;
};

std::string words_of(const SweepRun& run, const Candidate& candidate) {
  std::string words;
  for (const Setting& setting : Expander(run.space()).settings(candidate))
    words += fmt::format("{}{}={}", words.empty() ? "" : " ", setting.key, setting.value);
  return words;
}

double shown(const Judged& one, const std::vector<Objective>& objectives, std::size_t i) {
  return objectives[i].more ? -(*one.objectives)[i] : (*one.objectives)[i];
}

void print_front(const SweepRun& run, const std::string& title, const std::vector<Judged>& front,
                 const std::vector<Objective>& objectives) {
  fmt::print("\n{}\n", title);
  for (const Objective& objective : objectives) fmt::print("{:>24}", objective.column);
  fmt::print("  configuration\n");
  for (const Judged& one : front) {
    for (std::size_t i = 0; i < objectives.size(); ++i) fmt::print("{:>24.6g}", shown(one, objectives, i));
    fmt::print("  {}\n", words_of(run, one.candidate));
  }
}

ordered_json front_json(const SweepRun& run, const std::vector<Judged>& front,
                        const std::vector<Objective>& objectives) {
  ordered_json json = ordered_json::array();
  for (const Judged& one : front) {
    ordered_json member;
    for (std::size_t i = 0; i < objectives.size(); ++i) member[objectives[i].column] = shown(one, objectives, i);
    for (const Setting& setting : Expander(run.space()).settings(one.candidate))
      member["settings"][setting.key] = setting.value;
    member["points"] = ordered_json::array();
    for (const Point& point : run.points_of(one.candidate)) member["points"].push_back(point.id);
    json.push_back(member);
  }
  return json;
}

/// A misspelt objective shows when the first generation is done.
void require_judged(const SweepRun& run, const std::vector<Judged>& judged) {
  if (std::any_of(judged.begin(), judged.end(), [](const Judged& one) { return one.objectives.has_value(); })) return;
  throw Error(
      run.space().path,
      fmt::format("no result has all of the objectives {}", fmt::join(run.space().search.objectives, ", ")),
      fmt::format("`ctusim sweep collect {0}` and {0}/columns.csv list the columns", run.folder().path().string()));
}

}  // namespace

void search(SweepRun& run) {
  const SearchPlan& plan = run.space().search;
  const CandidateSpace space(run.space());
  const Expander expander(run.space());
  const Accept accept = [&](const Candidate& candidate) { return expander.accepts(candidate); };
  Judge judge(run);
  std::vector<Judged> guided;
  Nsga2 nsga2(space, plan.population, plan.seed, accept);
  for (std::uint32_t generation = 0; generation < plan.generations; ++generation) {
    const std::vector<Candidate> questions = nsga2.ask();
    if (questions.empty()) break;
    const std::vector<Judged> answers = judge.judge(questions);
    if (answers.empty()) return;
    nsga2.tell(answers);
    guided.insert(guided.end(), answers.begin(), answers.end());
    require_judged(run, guided);
    const std::vector<Judged> front = front_of(guided);
    fmt::print("generation {}: {} configurations, {} on the front\n", generation + 1, guided.size(), front.size());
  }
  const std::vector<Judged> random =
      judge.judge(draw_candidates(space, guided.size(), plan.seed, kRandomStream, accept));
  if (random.empty()) return;
  const Scale scale(guided, random, judge.objectives().size());
  const auto guided_front = front_of(guided), random_front = front_of(random);
  const double guided_covers = scale.covered(guided_front), random_covers = scale.covered(random_front);
  const auto& objectives = judge.objectives();
  print_front(run,
              fmt::format("guided: {} of {} on the front, hypervolume {:.4f}", guided_front.size(), guided.size(),
                          guided_covers),
              guided_front, objectives);
  print_front(run,
              fmt::format("random: {} of {} on the front, hypervolume {:.4f}", random_front.size(), random.size(),
                          random_covers),
              random_front, objectives);
  const ordered_json json = {{"format", "ctusim-search"},
                             {"objectives", plan.objectives},
                             {"seed", plan.seed},
                             {"guided",
                              {{"configurations", guided.size()},
                               {"hypervolume", guided_covers},
                               {"front", front_json(run, guided_front, objectives)}}},
                             {"random",
                              {{"configurations", random.size()},
                               {"hypervolume", random_covers},
                               {"front", front_json(run, random_front, objectives)}}}};
  run.folder().replace(run.folder().path() / "search.json", json.dump(1) + "\n");
}

}  // namespace ctu::sweep
