// A point of a sweep: one configuration on one trace with one engine, with everything that a worker on another machine
// needs to run it. A line of points.jsonl.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "sim/sweep/axis.h"

namespace ctu::sweep {

/// What rows say of the trace they were made with.
struct TraceFacts {
  std::string name;  ///< TraceSource::name
  std::string file;  ///< to open
  std::string hash, scene, ray_kind, levels;
  std::uint64_t trace_rays = 0, triangles = 0, image_bytes = 0;
  int r = 0, r_ray = 0;  ///< 0: no masks
  int lut_entries = 0;
  std::uint32_t box_bits = 32;
};

/// Opens the trace and reads what it says of itself; `scene` empty: as its manifest has it.
TraceFacts read_trace_facts(const std::string& name, const std::string& file, const std::string& scene);

struct Point {
  std::string id;  ///< 32 digits: what makes the result what it is, see point_id
  TraceFacts trace;
  std::string engine, design, config_hash;
  std::uint64_t first_ray = 0, rays = 0;
  Settings settings;              ///< the keys that the sweep moves
  std::vector<std::string> sets;  ///< every KEY=VALUE that is not at its default: the whole configuration
};

/// XXH3-128 of the resolved configuration, the trace, the range of its rays, the engine and the version of the rows.
std::string point_id(const Point& point);

/// The configuration of `sets` over the defaults and its design, hash and id filled in.
pipeline::UnitConfig config_of(const Point& point);

/// KEY=VALUE of everything that is not at its default.
std::vector<std::string> sets_of(const pipeline::UnitConfig& config);

/// `ctusim run` that repeats it, in the folder of the sweep.
std::string command_of(const Point& point);

/// A line without its end, and back; Error, at `where`, on what is no point or has an id that this program would not
/// give it: it was planned by another version.
std::string to_line(const Point& point);
Point point_from_line(const std::string& line, const std::string& where);

}  // namespace ctu::sweep
