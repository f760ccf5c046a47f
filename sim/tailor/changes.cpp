#include "sim/tailor/changes.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/pipeline/parameter.h"
#include "sim/config_file.h"
#include "sim/energy/on_chip_bits.h"
#include "sim/tailor/search.h"

namespace ctu::tailor {
namespace {

using pipeline::UnitConfig;

std::int64_t bits(Workbench& bench, const UnitConfig& config) {
  std::int64_t most = 0;
  for (std::size_t i = 0; i < bench.traces(); ++i)
    most = std::max(most, static_cast<std::int64_t>(bits_of(energy::on_chip_structures(bench.shape(i, config)))));
  return most;
}

/// The largest share of a trace's cycles that `other` saves.
double gain_of(const Trial& now, const Trial& other) {
  double most = -1;
  for (std::size_t i = 0; i < now.cycles.size(); ++i)
    most = std::max(most, 1 - static_cast<double>(other.cycles[i]) / static_cast<double>(now.cycles[i]));
  return most;
}

std::string reason_of(const Change& change, bool design) {
  if (design)
    return fmt::format("{}with {} these traces would take {:+.2f} % cycles",
                       change.after == "none" ? "culling is not needed to be fast enough: " : "", change.before,
                       -100 * change.gain);
  if (change.gain <= 0) return "putting it back is no faster on any of these traces";
  return fmt::format("putting it back would save {:.2f} % of the cycles at most", 100 * change.gain);
}

/// Whether a unit of this design has anything that the key is about.
bool matters(const std::string& key, cull::Design design) {
  const bool tables = design != cull::Design::None && design != cull::Design::Comparators;
  if (key == "mask_test.projection_tables") return design == cull::Design::Projection;
  if (key == "mask_test.rows" || key == "mask_test.banks" || key == "mask_test.ports" || key == "cell_locate.units")
    return tables;
  if (key == "comparators.units") return design == cull::Design::Comparators;
  return true;
}

}  // namespace

std::vector<Change> changes_of(Workbench& bench, const UnitConfig& start, const UnitConfig& tailored) {
  std::vector<Change> changes;
  for (const pipeline::Parameter& parameter : pipeline::parameters()) {
    const auto before = parameter.get(start), after = parameter.get(tailored);
    if (before == after || !matters(parameter.key, tailored.mask_test.design)) continue;
    const UnitConfig put_back = with_value(tailored, parameter.key, before);
    const Trial& other = bench.run(put_back);
    Change change{parameter.key, sim::to_text(before), sim::to_text(after), 0, 0, 0, ""};
    if (other.ran()) {
      change.saved_um2 = bench.area(put_back) - bench.area(tailored);
      change.saved_bits = bits(bench, put_back) - bits(bench, tailored);
      change.gain = gain_of(bench.run(tailored), other);
      change.reason = reason_of(change, parameter.key == "mask_test.design");
    } else {
      change.reason = "belongs to another key that changed: " + other.refusal;
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

std::vector<std::string> missing_parts(const UnitParts& parts, const UnitConfig& tailored) {
  std::vector<std::string> lines;
  if (tailored.mask_test.design == cull::Design::None)
    lines.push_back(
        "cell_locate and mask_test, with slab times, keys and masks of all contexts: not needed to be fast "
        "enough. Any trace still gets its true hits, with more visits");
  if (!parts.spheres) lines.push_back("sphere_test: no scene has spheres");
  if (!parts.primitive_boxes) lines.push_back("primitive_cull: no leaf has a box beside its primitives");
  if (parts.packet_entries == 0) lines.push_back("packet_cull: no rays travel in packets");
  if (parts.trees == 1) lines.push_back("the table of roots in ray_queue: all rays walk one tree");
  if (parts.box_bits == 32) lines.push_back("box_decode: all boxes are binary32");
  if (!parts.spills)
    lines.push_back(fmt::format("spills of traversal_stack: no ray of these trees can hold more than {} entries",
                                tailored.stack.entries));
  if (parts.r != 0 && parts.entries == 0) lines.push_back("the compression LUT: no masks are compressed");
  lines.push_back(fmt::format("leaf buffers beyond {} bytes: no leaf is larger", parts.leaf_bytes));
  if (tailored.mask_test.rows == cull::TableRows::Reachable && parts.r != 0)
    lines.push_back("table rows of rays that begin inside a box: no ray needs one");
  return lines;
}

std::vector<std::string> advice(Workbench& bench, const UnitConfig& tailored,
                                const std::vector<std::string>& unread_rows) {
  std::vector<std::string> lines;
  energy::UnitShape shape = bench.shape(0, tailored);
  if (shape.box_bits == 32) {
    const auto whole = bits_of(energy::on_chip_structures(shape));
    shape.box_bits = 16;
    const auto reduced = bits_of(energy::on_chip_structures(shape));
    const auto change = static_cast<std::int64_t>(reduced) - static_cast<std::int64_t>(whole);
    lines.push_back(
        fmt::format("boxes of 16 bits (record --box-bits 16) would change the bits on chip by {:+}, and "
                    "shorten every node by 32 bytes; `ctusim precision SCENE` measures what they cost",
                    change));
  }
  lines.insert(lines.end(), unread_rows.begin(), unread_rows.end());
  return lines;
}

}  // namespace ctu::tailor
