#include "traces/slice.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "traces/trace_reader.h"
#include "traces/trace_writer.h"
#include "traces/validate_block.h"

namespace ctu::traces {
namespace {

Manifest manifest_of_slice(const TraceReader& reader, const RayRange& range) {
  Manifest manifest = reader.manifest();
  std::erase_if(manifest.designs, [](const DesignCounts& entry) { return !entry.stored; });
  for (DesignCounts& entry : manifest.designs) entry.counts = {};
  manifest.cut_from = reader.hash();
  manifest.cut_first = range.first;
  return manifest;
}

/// The listed differences that lie in the range, renumbered.
std::vector<Difference> differences_in(const Manifest& manifest, const RayRange& range) {
  std::vector<Difference> kept;
  for (Difference difference : manifest.differences) {
    if (difference.ray < range.first || difference.ray >= range.last) continue;
    difference.ray -= range.first;
    kept.push_back(difference);
  }
  return kept;
}

}  // namespace

std::string slice(const std::string& in, const std::string& out, RayRange range) {
  const TraceReader reader(in);
  range.last = std::min(range.last, reader.rays());
  if (range.first >= range.last) throw Error(in, "the slice has no rays", "choose a range within the trace");
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const Manifest manifest = manifest_of_slice(reader, range);
  std::vector<DesignCounts> designs = manifest.designs;
  TraceWriter writer(out, manifest, image, reader.compression().get());

  for (std::uint64_t ray = range.first; ray < range.last;) {
    const std::uint64_t number = reader.block_of(ray), start = reader.first_ray(number);
    const std::uint64_t last = std::min(range.last, reader.first_ray(number + 1));
    reference::RayBlock part;
    std::vector<reference::StepList> steps;
    const auto read = [&](std::optional<cull::Design> design) {
      const reference::RayBlock block = reader.read_block(number, design);
      validate_block(block, bvh, manifest.masks, in, manifest.packets.plan);
      return part_of(block, ray - start, last - start);
    };
    part = read(std::nullopt);
    if (manifest.packets.any() && !part.packets.walked())
      throw Error(in, fmt::format("rays {} to {} cut a packet in two", range.first, range.last - 1),
                  fmt::format("begin and end with a packet; those of a block have {} rays, but for its last one",
                              manifest.packets.plan.size));
    for (DesignCounts& entry : designs) {
      steps.push_back(read(entry.design).steps);
      entry.counts += reference::count_steps(steps.back(), 0, steps.back().rays());
    }
    writer.add(part, steps);
    ray = last;
  }
  const std::vector<Difference> differences = differences_in(manifest, range);
  for (DesignCounts& entry : designs)
    entry.different_hits = static_cast<std::uint64_t>(
        std::count_if(differences.begin(), differences.end(), [&](const auto& d) { return d.design == entry.design; }));
  return writer.finish(designs, differences);
}

}  // namespace ctu::traces
