#include "sim/check/campaign.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/check/cell_sample.h"
#include "sim/check/judge.h"

namespace ctu::sim::check {
namespace {

// Rationals are slow.
constexpr double kCellSamples = 0.5;  ///< share of scenes in which one ray has its cells counted, at one node

struct SceneOutcome {
  Tally tally;
  std::vector<Failure> failures;
};

/// One thread's share of a campaign.
class Worker {
 public:
  Worker(const CampaignOptions& options, TesterCache& testers)
      : options_(options), testers_(testers), execution_(options.make_execution()) {}

  SceneOutcome run(SceneNumber number) {
    CaseRandom random = scene_random(options_.seed, number);
    CheckScene scene = make_scene(options_.seed, number, options_.draw_setup, random, testers_);
    leave_out_rays(scene);
    const Answers answers = execution_->run(scene, random);
    SceneOutcome outcome;
    outcome.tally.scenes = 1;
    judge_answers(scene, answers, outcome);
    count_differences(scene, answers, outcome);
    count_cells(scene, random, outcome);
    return outcome;
  }

 private:
  void leave_out_rays(CheckScene& scene) const {
    const std::uint64_t most = std::max<std::uint64_t>(options_.most_pairs / scene.bvh.triangles.size(), 1);
    if (scene.hard.rays.size() > most) scene.hard.rays.resize(most);
  }

  void judge_answers(const CheckScene& scene, const Answers& answers, SceneOutcome& outcome) {
    Judge judge(scene);
    for (std::uint32_t ray = 0; ray < scene.hard.rays.size(); ++ray) {
      const std::string wrong = judge.judge(scene.hard.rays[ray], answers.hits[ray], outcome.tally);
      if (!wrong.empty()) add_failure(scene, ray, wrong, outcome);
    }
    judge.finish(outcome.tally);
  }

  void count_differences(const CheckScene& scene, const Answers& answers, SceneOutcome& outcome) {
    outcome.tally.differences = answers.differences.size() + answers.other_differences;
    for (const Difference& difference : answers.differences)
      add_failure(scene, difference.ray, difference.what, outcome);
    if (answers.differences.empty() && answers.other_differences != 0)
      add_failure(scene, 0, "visits that are not the reference's, by some ray of the scene", outcome);
  }

  void count_cells(const CheckScene& scene, CaseRandom& random, SceneOutcome& outcome) {
    if (!random.chance(kCellSamples)) return;
    const auto ray = static_cast<std::uint32_t>(random.below(static_cast<int>(scene.hard.rays.size())));
    const auto any = static_cast<std::uint32_t>(random.below(static_cast<int>(scene.bvh.nodes.size())));
    const std::uint32_t node = random.chance(0.5) ? 0 : any;
    sample_cells(scene, scene.hard.rays[ray], node, testers_, outcome.tally);
    if (outcome.tally.cells_lost != 0)
      add_failure(scene, ray, fmt::format("touches cells of node {} that are not marked", node), outcome);
  }

  void add_failure(const CheckScene& scene, std::uint32_t ray, const std::string& what, SceneOutcome& outcome) {
    ++outcome.tally.failed_rays;
    if (outcome.failures.size() < options_.kept_failures)
      outcome.failures.push_back({scene.number, ray, to_string(scene.setup), what});
  }

  const CampaignOptions& options_;
  TesterCache& testers_;
  std::unique_ptr<Execution> execution_;
};

/// Takes outcomes from all threads and adds them up in order, until the budget is used.
class Ledger {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Ledger(const CampaignOptions& options) : options_(options) {
    result_.by_generator.resize(options.generators.size());
  }

  bool open() const {
    if (closed_) return false;
    return options_.only_scene || options_.budget.cases != 0 || seconds() < options_.budget.seconds;
  }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

  template <class Progress>
  void put(std::uint64_t place, SceneOutcome outcome, const Progress& progress) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(place, std::move(outcome));
    for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_; first = waiting_.begin()) {
      if (!used_up()) add(first->second);
      waiting_.erase(first);
      ++next_;
    }
    closed_ = closed_ || used_up();
    if (progress) progress(cases_, seconds());
  }
  void close() { closed_ = true; }

  CampaignResult finish() {
    result_.seconds = seconds();
    return std::move(result_);
  }

 private:
  bool used_up() const { return !options_.only_scene && options_.budget.cases != 0 && cases_ >= options_.budget.cases; }

  void add(SceneOutcome& outcome) {
    result_.by_generator[next_ % options_.generators.size()] += outcome.tally;
    if (options_.stop_at_failure && outcome.tally.lost != 0) closed_ = true;
    cases_ += outcome.tally.rays;
    for (Failure& failure : outcome.failures)
      if (result_.failures.size() < options_.kept_failures) result_.failures.push_back(std::move(failure));
  }

  const CampaignOptions& options_;
  const Clock::time_point started_ = Clock::now();
  std::mutex mutex_;
  std::atomic<bool> closed_ = false;
  std::uint64_t next_ = 0, cases_ = 0;
  std::map<std::uint64_t, SceneOutcome> waiting_;
  CampaignResult result_;
};

/// Runs `body` on so many threads; the first exception is rethrown when all have ended.
template <class Body>
void on_threads(int threads, const Body& body) {
  std::exception_ptr failure;
  std::mutex mutex;
  const auto guarded = [&] {
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back(guarded);
  guarded();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

/// What stops a campaign, a deadlock say, must not hide the scene that did it.
SceneOutcome run_named(Worker& worker, const CampaignOptions& options, SceneNumber number) {
  try {
    return worker.run(number);
  } catch (...) {
    fmt::print(stderr, "stopped by: ctusim check --seed {} --generator {} --scene {}\n", options.seed,
               generators()[number.generator].name, number.scene);
    throw;
  }
}

}  // namespace

Budget parse_budget(const std::string& text) {
  const auto refuse = [&]() -> Budget {
    throw Error("--budget", fmt::format("\"{}\" is neither cases nor a time", text), "give 1000000, 60s or 5m");
  };
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(end, text.data() + text.size());
  if (error != std::errc() || !(number > 0) || !(number <= 1e15)) return refuse();
  if (unit == "s") return {0, number};
  if (unit == "m") return {0, 60 * number};
  if (!unit.empty() || number < 1) return refuse();
  return {static_cast<std::uint64_t>(number), 0};
}

Tally CampaignResult::total() const {
  Tally total;
  for (const Tally& tally : by_generator) total += tally;
  return total;
}

CampaignResult run_campaign(const CampaignOptions& options,
                            const std::function<void(std::uint64_t cases, double seconds)>& progress) {
  TesterCache testers;
  Ledger ledger(options);
  std::atomic<std::uint64_t> next = 0;
  const std::uint64_t generators = options.generators.size();
  const std::uint64_t last = options.only_scene ? generators : UINT64_MAX;
  on_threads(options.threads, [&] {
    try {
      Worker worker(options, testers);
      while (ledger.open()) {
        const std::uint64_t place = next++;
        if (place >= last) return;
        const SceneNumber number{options.generators[place % generators],
                                 options.only_scene.value_or(place / generators)};
        ledger.put(place, run_named(worker, options, number), progress);
      }
    } catch (...) {
      ledger.close();
      throw;
    }
  });
  return ledger.finish();
}

}  // namespace ctu::sim::check
