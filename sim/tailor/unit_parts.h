// The parts that a unit was built with: what configuration keys do not say because a trace's image decides it, and what
// a unit tailored to some scenes may therefore lack for another. They stand in the tailored configuration under
// [parts].
#pragma once

#include <map>
#include <string>

#include "model/pipeline/parameter.h"
namespace ctu::energy {
struct UnitShape;
}

namespace ctu::tailor {

struct UnitParts {
  bool spheres = false;          ///< sphere_test
  bool primitive_boxes = false;  ///< primitive_cull
  int packet_entries = 0;        ///< of packet_cull, for a packet; 0: there is none
  int trees = 1;                 ///< whose roots ray_queue has; 1: no table of them
  bool spills = false;           ///< the stack's way to memory
  int box_bits = 32;             ///< below 32: box_decode
  int r = 0, r_ray = 0;          ///< of the mask test; 0: there is none
  int entries = 0;               ///< of the compression LUT; 0: masks are not compressed
  int leaf_bytes = 0;            ///< that leaf_fetch keeps of a leaf
  bool operator==(const UnitParts&) const = default;
};

/// What a unit of this shape is built with.
UnitParts parts_of(const energy::UnitShape& shape);
/// What serves both: parts that either needs. Error when one unit cannot (masks or boxes of two kinds); `what` names
/// the second.
UnitParts joined(const UnitParts& a, const UnitParts& b, const std::string& what);

/// As the section [parts] of a configuration, and back; Error on keys that are no parts, named with `place`.
std::string to_toml(const UnitParts& parts);
UnitParts parts_from(const std::map<std::string, pipeline::ParameterValue>& values, const std::string& place);

/// Throws Error naming the part that work of this shape needs and the unit does not have; `trace` is what needs it.
void require_parts(const UnitParts& built, const energy::UnitShape& needed, const std::string& trace);

}  // namespace ctu::tailor
