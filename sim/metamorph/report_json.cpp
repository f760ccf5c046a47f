#include <fstream>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/metamorph/report.h"

namespace ctu::sim::metamorph {
namespace {

using nlohmann::ordered_json;

ordered_json row_json(const CheckRow& row) {
  ordered_json json{{"transformation", row.name},
                    {"rays", row.rays},
                    {"changed_hits", row.changed.all()},
                    {"lost_hits", row.changed.lost},
                    {"near_misses", row.changed.near_misses},
                    {"ties", row.changed.ties},
                    {"declined", row.declined}};
  if (row.same == Same::NotPromised) return json;
  json["same_bits"] = row.same == Same::Yes;
  json["rays_compared"] = row.rays - row.not_compared;
  return json;
}

ordered_json edges_json(const EdgeRow& row) {
  return {{"closed_parts", row.parts},
          {"triangles", row.triangles},
          {"edges", row.edges},
          {"vertices", row.vertices},
          {"folds", row.folds},
          {"rays", row.rays},
          {"leaks", row.found.leaks},
          {"declined", row.found.declined},
          {"passed_by", row.found.passed_by}};
}

}  // namespace

void write_json(const std::vector<NamedReport>& reports, const std::string& path) {
  ordered_json json{{"format", "ctusim-metamorph"}, {"version", 1}, {"scenes", ordered_json::array()}};
  for (const auto& [name, report] : reports) {
    ordered_json scene{{"scene", name}, {"triangles", report.triangles}, {"passed", report.passed()}};
    for (const CheckRow& row : report.rows) scene["transformations"].push_back(row_json(row));
    if (report.edges_checked) scene["edges"] = edges_json(report.edges);
    scene["left_out"] = report.left_out;
    scene["defects"] = report.defects;
    json["scenes"].push_back(scene);
  }
  std::ofstream out(path);
  out << json.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
  if (!out.flush()) throw Error(path, "the result could not be written", "check the folder and the free space");
}

}  // namespace ctu::sim::metamorph
