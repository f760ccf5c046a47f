// `ctusim tables`: what each mask-test design keeps on chip, in exact bits (DESIGN section 4), with all rows, with keys
// folded, and with the rows left out that no ray from outside a box can reach.
#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/on_chip_tables.h"
#include "sim/commands.h"
#include "sim/scene_args.h"

namespace ctu::sim {
namespace {

using cull::Design;
using cull::TableRows;

std::string memories_of(const std::vector<cull::OnChipTable>& tables) {
  std::string text;
  for (const cull::OnChipTable& table : tables)
    text += fmt::format("{}{} {} x {}", text.empty() ? "" : ", ", table.name, table.rows, table.row_bits);
  return text.empty() ? "none" : text;
}

void print_header(const TablesArgs& args, const cull::MaskOptions& masks) {
  fmt::print("R {}, R_ray {}, {}\n\n", masks.resolution, masks.ray_resolution,
             masks.entries == 0 ? "object masks not compressed" : fmt::format("{} LUT entries", masks.entries));
  if (args.markdown)
    fmt::print("| design | rows | bits | KiB | memories (rows x bits) |\n| --- | --- | ---: | ---: | --- |\n");
  else
    fmt::print("{:<13}{:<11}{:>14}{:>12}  memories (rows x bits)\n", "design", "rows", "bits", "KiB");
}

void print_row(const TablesArgs& args, Design design, TableRows rows, const cull::OnChipTables& tables) {
  const double kibibytes = double(tables.bits()) / (8 * 1024);
  const std::string memories = memories_of(tables.tables());
  if (args.markdown)
    fmt::print("| {} | {} | {} | {:.2f} | {} |\n", to_string(design), to_string(rows), tables.bits(), kibibytes,
               memories);
  else
    fmt::print("{:<13}{:<11}{:>14}{:>12.2f}  {}\n", to_string(design), to_string(rows), tables.bits(), kibibytes,
               memories);
}

void print_refused(const TablesArgs& args, Design design, const std::string& problem) {
  if (args.markdown)
    fmt::print("| {} | refused | | | {} |\n", to_string(design), problem);
  else
    fmt::print("{:<13}refused: {}\n", to_string(design), problem);
}

void print_design(const TablesArgs& args, Design design, const cull::MaskOptions& masks) {
  try {
    require_possible(design, masks);
  } catch (const Error& error) {
    return print_refused(args, design, error.problem());
  }
  // How many masks are distinct is the one size that has no closed form.
  std::optional<cull::DedupTable> dedup;
  if (design == Design::Dedup) dedup.emplace(masks.resolution, masks.ray_resolution, nullptr);
  for (const TableRows rows : {TableRows::All, TableRows::Folded, TableRows::Reachable}) {
    const cull::OnChipTables tables(design, masks, masks.entries, dedup ? &*dedup : nullptr, rows,
                                    args.projection_tables);
    print_row(args, design, rows, tables);
    if (design == Design::Comparators) return;
  }
}

}  // namespace

int tables_command(const TablesArgs& args) {
  cull::MaskOptions masks;
  masks.resolution = args.resolution;
  masks.ray_resolution = args.ray_resolution == 0 ? args.resolution : args.ray_resolution;
  masks.entries = args.entries;
  cull::validate(masks);
  if (args.projection_tables != 1 && args.projection_tables != 3)
    throw Error("--projection-tables", fmt::format("is {}", args.projection_tables), "give 1 or 3");
  print_header(args, masks);
  for (const Design design :
       {Design::MaskLut, Design::BitTable, Design::Dedup, Design::Projection, Design::Comparators})
    print_design(args, design, masks);
  return 0;
}

}  // namespace ctu::sim
