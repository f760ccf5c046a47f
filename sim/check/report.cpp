#include "sim/check/report.h"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/base/version.h"

namespace ctu::sim::check {
namespace {

using Json = nlohmann::ordered_json;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

void print_row(std::string_view name, const Tally& t) {
  fmt::print("{:<24}{:>13}{:>13}{:>13}{:>6}{:>10}{:>11}{:>10}{:>10.1f}{:>8.2f}{:>9.3f}\n", name, t.rays, t.exact_hits,
             t.kept, t.lost, t.declined, t.near_misses, t.ties, share(t.cells_over, t.cells_exact),
             share(t.uncertain_lanes, t.lanes), share(t.oracle.summed, t.oracle.asked));
}

Json json_of(std::string_view name, const Tally& t) {
  return {{"generator", name},
          {"scenes", t.scenes},
          {"cases", t.rays},
          {"exact_hits", t.exact_hits},
          {"hits_kept", t.kept},
          {"hits_lost", t.lost},
          {"declined_by_triangle_test", t.declined},
          {"misplaced_by_triangle_test", t.misplaced},
          {"near_misses", t.near_misses},
          {"ties", t.ties},
          {"invented_hits", t.invented},
          {"differences_from_reference", t.differences},
          {"failed_rays", t.failed_rays},
          {"lanes", t.lanes},
          {"uncertain_lanes", t.uncertain_lanes},
          {"sampled_lanes", t.sampled_lanes},
          {"cells_marked", t.cells_marked},
          {"cells_exact", t.cells_exact},
          {"cells_over_marked", t.cells_over},
          {"cells_lost", t.cells_lost},
          {"oracle_questions", t.oracle.asked},
          {"oracle_exact_sums", t.oracle.summed},
          {"oracle_rationals", t.oracle.rational}};
}

std::string_view name_at(const CampaignOptions& options, std::size_t i) {
  return generators()[options.generators[i]].name;
}

void add_head(Json& json, const ReportHead& head, double seconds) {
  json["tool"] = std::string("ctusim ") + tool_version();
  json["command"] = head.command;
  json["engine"] = head.engine;
  json["seed"] = head.seed;
  json["threads"] = head.threads;
  json["seconds"] = seconds;
}

void save(const Json& json, const std::string& path) {
  std::ofstream file(path);
  file << json.dump(2) << '\n';
  if (!file.flush()) throw Error(path, "cannot be written", "choose a path that can");
}

}  // namespace

void print_report(const ReportHead& head, const CampaignOptions& options, const CampaignResult& result) {
  const Tally total = result.total();
  fmt::print("{:<24}{:>13}{:>13}{:>13}{:>6}{:>10}{:>11}{:>10}{:>10}{:>8}{:>9}\n", "generator", "cases", "exact hits",
             "kept", "lost", "declined", "near-miss", "ties", "over %", "unc. %", "sums %");
  for (std::size_t i = 0; i < options.generators.size(); ++i) print_row(name_at(options, i), result.by_generator[i]);
  print_row("total", total);
  fmt::print(
      "engine {}, seed {}: {} scenes, {} cases in {:.1f} s on {} threads, {:.0f} cases/s; {} oracle questions, {} by "
      "exact sums, {} by rationals\n",
      head.engine, head.seed, total.scenes, total.rays, result.seconds, head.threads,
      static_cast<double>(total.rays) / result.seconds, total.oracle.asked, total.oracle.summed, total.oracle.rational);
  fmt::print(
      "hits lost: {}; misplaced by the triangle test: {}; cells lost: {} in {} sampled lanes; invented hits: {}; "
      "differences from the reference: {}\n",
      total.lost, total.misplaced, total.cells_lost, total.sampled_lanes, total.invented, total.differences);
}

void write_report(const ReportHead& head, const CampaignOptions& options, const CampaignResult& result,
                  const std::string& path) {
  const Tally total = result.total();
  Json json = json_of("total", total);
  json.erase("generator");
  add_head(json, head, result.seconds);
  json["cases_per_second"] = static_cast<double>(total.rays) / result.seconds;
  Json& rows = json["generators"] = Json::array();
  for (std::size_t i = 0; i < options.generators.size(); ++i)
    rows.push_back(json_of(name_at(options, i), result.by_generator[i]));
  Json& failures = json["failures"] = Json::array();
  for (const Failure& failure : result.failures)
    failures.push_back({{"generator", generators()[failure.number.generator].name},
                        {"scene", failure.number.scene},
                        {"ray", failure.ray},
                        {"setup", failure.setup},
                        {"what", failure.what}});
  save(json, path);
}

void write_comparison(const ReportHead& head, const CampaignOptions& options, const ComparisonResult& result,
                      const std::string& path) {
  Json json;
  add_head(json, head, result.seconds);
  Json& rows = json["generators"] = Json::array();
  for (std::size_t i = 0; i < options.generators.size(); ++i) {
    const ComparisonRow& row = result.by_generator[i];
    Json forms;
    for (std::size_t form = 0; form < kForms.size(); ++form)
      forms[std::string(kForms[form])] = {{"lost", row.forms[form].lost},
                                          {"box_hits", row.forms[form].box_hits},
                                          {"culled", row.forms[form].culled},
                                          {"tests", row.forms[form].tests}};
    rows.push_back({{"generator", name_at(options, i)},
                    {"cases", row.rays},
                    {"exact_hits", row.exact_hits},
                    {"forms", std::move(forms)}});
  }
  save(json, path);
}

}  // namespace ctu::sim::check
