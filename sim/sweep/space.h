// A space of points to run, as the user writes it: which traces, which configurations, and how to walk through them.
//
//   traces = ["bunny.ctut"]                      # files, relative to this one
//   [[record]]                                   # and traces that the sweep records once; options of `ctusim record`
//   scene = ["bunny", "sponza"]
//   r = [4, 6]                                   # a list: one trace for each of its values
//   [set]                                        # over the defaults (and over `config = "FILE"`), for every point
//   unit.contexts = 64
//   [axes]                                       # every combination of these
//   mask_test.design = ["none", "projection"]
//   node_cache.bytes = { log2 = [8192, 131072] }
//   unit.contexts = { range = [8, 64, 8] }
//   [[zip]]                                      # keys that move together are one axis
//   cell_locate.units = [1, 4]
//   comparators.units = [1, 4]
//   [[exclude]]                                  # what fits all lines is left out
//   mask_test.design = "none"
//   cell_locate.units = { above = 1 }
//   [search]                                     # without it: the whole grid
//   mode = "random"
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/sweep/axis.h"

namespace ctu::sweep {

/// A trace that points run on.
struct TraceSource {
  std::string name;                       ///< as rows show it: the file as written, or traces/NAME.ctut in the folder
  std::string file;                       ///< to open, when the user has it; empty: it is recorded
  std::string scene;                      ///< short name; of what is recorded only
  std::vector<std::string> record_words;  ///< `ctusim record` behind these makes it
};

/// Traces that differ in their scenes alone: a configuration is judged on all of them together.
struct TraceGroup {
  Settings settings;  ///< what was recorded otherwise than in other groups, keys "record.r", ...
  std::vector<std::size_t> traces;
};

/// A line of [[exclude]].
struct Condition {
  std::string key;  ///< of the unit, "record.OPTION", or "scene"
  std::vector<std::string> values;
  std::optional<std::int64_t> below, above;
  bool fits(const std::string& value) const;
};
using Exclusion = std::vector<Condition>;

enum class SearchMode : std::uint8_t { Grid, Random, Pareto };

struct SearchPlan {
  SearchMode mode = SearchMode::Grid;
  std::uint64_t seed = 1;
  std::uint64_t points = 0;             ///< random: configurations drawn
  std::vector<std::string> objectives;  ///< pareto: columns of results, less is better; "max:COLUMN" for more
  std::uint32_t population = 24, generations = 8;
};

struct Space {
  std::string path;
  std::string text;  ///< of the file
  std::string engine = "cycle";
  std::uint64_t first_ray = 0, rays = 0;  ///< of every trace; rays 0: to the end
  std::vector<TraceSource> traces;
  std::vector<TraceGroup> groups;
  std::string config_path;        ///< empty: the defaults
  std::vector<std::string> sets;  ///< over it, KEY=VALUE
  std::vector<Axis> axes;
  std::vector<Exclusion> exclusions;
  SearchPlan search;

  /// Keys of the unit that axes set, in their order.
  std::vector<std::string> swept_keys() const;
};

/// Throws Error with file and line on what is not understood, and on values that no unit can have.
Space read_space(const std::string& path);

/// "grid", "random", "pareto".
const char* to_string(SearchMode mode);

}  // namespace ctu::sweep
