#include "model/pipeline/work.h"

#include <string>

#include "model/base/error.h"
#include "model/pipeline/exec_source.h"
#include "model/pipeline/memory_map.h"

namespace ctu::pipeline {

void check_fits(const UnitConfig& config, const Work& work) {
  const cull::Design design = config.mask_test.design;
  if (design == cull::Design::Ideal)
    throw Error("mask_test.design", "ideal culling exists in software only", "choose another design");
  if (work.tester.design() != design)
    throw Error("mask_test.design",
                "the unit has " + std::string(cull::to_string(design)) + ", the tables were built for " +
                    std::string(cull::to_string(work.tester.design())),
                "build the tables for the unit's design");
  const int r = work.tester.options().resolution;
  const cull::CompressionLut* const lut = work.tester.compression_lut();
  const int bits_needed = lut != nullptr ? lut->index_bits() : r * r * r;
  if (design != cull::Design::None && work.image.layout.mask_bits != static_cast<std::uint32_t>(bits_needed))
    throw Error("image",
                "its nodes hold " + std::to_string(work.image.layout.mask_bits) + " bits a lane, " +
                    (lut != nullptr ? "an index into the compression LUT has " : "an object mask has ") +
                    std::to_string(bits_needed),
                "build image and tables for the same masks");
  const int entry_bytes = stack_entry_bytes(work.image.layout.primitive_boxes);
  if (config.stack.spill_batch * entry_bytes > config.memory.line_bytes)
    throw Error("stack.spill_batch, memory.line_bytes",
                "a batch of " + std::to_string(entry_bytes) + "-byte entries is larger than a line",
                "choose a smaller batch, or a trace without primitive boxes");
  const reference::PacketPlan packets = work.rays.packets();
  if (packets.size > config.unit.contexts)
    throw Error("unit.contexts",
                "packets of " + std::to_string(packets.size) + " rays never get whole in " +
                    std::to_string(config.unit.contexts) + " contexts",
                "give as many contexts as a packet has rays, or record smaller packets");
  if (3 * work.image.depth + 1 + packets.most_entries > kMaxStackEntries)
    throw Error("image", "a tree of depth " + std::to_string(work.image.depth) + " needs more stack than a ray has",
                "allow more triangles in a leaf");
}

}  // namespace ctu::pipeline
