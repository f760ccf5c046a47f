#include "sim/tailor/unit_parts.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/energy/unit_shape.h"

namespace ctu::tailor {
namespace {

/// Calls `visit(name, member)` for each part.
template <class Parts, class Visit>
void for_each_part(Parts& parts, const Visit& visit) {
  visit("spheres", parts.spheres);
  visit("primitive_boxes", parts.primitive_boxes);
  visit("packet_entries", parts.packet_entries);
  visit("trees", parts.trees);
  visit("spills", parts.spills);
  visit("box_bits", parts.box_bits);
  visit("r", parts.r);
  visit("r_ray", parts.r_ray);
  visit("entries", parts.entries);
  visit("leaf_bytes", parts.leaf_bytes);
}

/// Asks for the masks' kind only where there is a mask test on both sides.
bool same_masks(const UnitParts& a, const UnitParts& b) {
  if (a.r == 0 || b.r == 0) return a.r == b.r;
  return std::tie(a.r, a.r_ray) == std::tie(b.r, b.r_ray) && (a.entries > 0) == (b.entries > 0);
}

std::string masks_text(const UnitParts& parts) {
  return fmt::format("R = {}, R_ray = {}{}", parts.r, parts.r_ray,
                     parts.entries > 0 ? fmt::format(", compressed to {} entries", parts.entries) : "");
}

}  // namespace

UnitParts parts_of(const energy::UnitShape& shape) {
  UnitParts parts;
  parts.spheres = shape.spheres;
  parts.primitive_boxes = shape.primitive_boxes;
  parts.packet_entries = shape.packet_entries;
  parts.trees = shape.trees;
  parts.spills = shape.spills;
  parts.box_bits = static_cast<int>(shape.box_bits);
  parts.r = shape.culls() ? shape.resolution : 0;
  parts.r_ray = shape.culls() ? shape.ray_resolution : 0;
  parts.entries = shape.culls() ? shape.entries : 0;
  parts.leaf_bytes = static_cast<int>(shape.leaf_bytes);
  return parts;
}

UnitParts joined(const UnitParts& a, const UnitParts& b, const std::string& what) {
  const auto refuse = [&](const std::string& why) {
    throw Error(what, why, "tailor a unit for each, or record the traces alike");
  };
  if (!same_masks(a, b)) refuse(fmt::format("has masks of {}, and another trace has {}", masks_text(b), masks_text(a)));
  if (a.box_bits != b.box_bits)
    refuse(fmt::format("has boxes of {} bits, and another trace has {}", b.box_bits, a.box_bits));
  if (a.primitive_boxes != b.primitive_boxes) refuse("and another trace differ in boxes beside primitives");
  if ((a.packet_entries == 0) != (b.packet_entries == 0)) refuse("and another trace differ in rays in packets");
  UnitParts both = a;
  both.spheres |= b.spheres;
  both.packet_entries = std::max(a.packet_entries, b.packet_entries);
  both.trees = std::max(a.trees, b.trees);
  both.spills |= b.spills;
  both.entries = std::max(a.entries, b.entries);
  both.leaf_bytes = std::max(a.leaf_bytes, b.leaf_bytes);
  return both;
}

std::string to_toml(const UnitParts& parts) {
  std::string text = "[parts]\n";
  for_each_part(parts, [&](const char* name, const auto& value) { text += fmt::format("{} = {}\n", name, value); });
  return text;
}

UnitParts parts_from(const std::map<std::string, pipeline::ParameterValue>& values, const std::string& place) {
  UnitParts parts;
  std::size_t known = 0;
  for_each_part(parts, [&](const char* name, auto& member) {
    const auto found = values.find(name);
    if (found == values.end()) return;
    ++known;
    using Value = std::conditional_t<std::is_same_v<std::decay_t<decltype(member)>, bool>, bool, std::int64_t>;
    const auto* value = std::get_if<Value>(&found->second);
    if (value == nullptr) throw Error(place, fmt::format("parts.{} has a value of another kind", name), "");
    member = static_cast<std::decay_t<decltype(member)>>(*value);
  });
  if (known != values.size())
    throw Error(place, "[parts] has a key that names no part", "leave the section as `ctusim tailor` wrote it");
  return parts;
}

void require_parts(const UnitParts& built, const energy::UnitShape& needed, const std::string& trace) {
  const UnitParts wanted = parts_of(needed);
  const auto refuse = [&](const std::string& part, const std::string& why) {
    throw Error(trace, fmt::format("needs {}, which the tailored unit does not have: {}", part, why),
                "tailor it again with this trace among the others, or run a configuration without [parts]");
  };
  if (wanted.spheres && !built.spheres) refuse("sphere_test", "its scene has spheres");
  if (wanted.primitive_boxes && !built.primitive_boxes)
    refuse("primitive_cull", "its leaves have a box beside every primitive");
  if (!wanted.primitive_boxes && built.primitive_boxes)
    refuse("leaves without boxes", "the unit reads a box beside every primitive");
  if (wanted.packet_entries > built.packet_entries)
    refuse(built.packet_entries == 0 ? "packet_cull" : "more entries of a packet in packet_cull",
           fmt::format("its rays travel in packets of up to {} entries", wanted.packet_entries));
  if (wanted.packet_entries == 0 && built.packet_entries > 0)
    refuse("rays that begin alone", "the unit takes them in packets");
  if (wanted.trees > built.trees)
    refuse("a larger table of roots in ray_queue", fmt::format("{} trees, it has {}", wanted.trees, built.trees));
  if (wanted.box_bits != built.box_bits)
    refuse(wanted.box_bits < 32 ? "box_decode" : "boxes of binary32",
           fmt::format("its boxes have {} bits a coordinate, those of the unit {}", wanted.box_bits, built.box_bits));
  if (built.r != 0 && !same_masks(built, wanted))
    refuse(fmt::format("a mask test of {}", masks_text(wanted)), fmt::format("it has one of {}", masks_text(built)));
  if (wanted.entries > built.entries)
    refuse("a larger compression LUT", fmt::format("{} entries, there are {}", wanted.entries, built.entries));
  if (wanted.spills && !built.spills)
    refuse("spills of traversal_stack",
           fmt::format("rays of its tree may hold more than {} entries", needed.config.stack.entries));
  if (wanted.leaf_bytes > built.leaf_bytes)
    refuse("a larger leaf buffer", fmt::format("leaves of {} bytes, it keeps {}", wanted.leaf_bytes, built.leaf_bytes));
}

}  // namespace ctu::tailor
