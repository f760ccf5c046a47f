// Cem Yuksel's .hair: a 128-byte header, then arrays whose presence the header's bits tell
// (cemyuksel.com/research/hairmodels).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/base/error.h"
#include "model/scene/byte_cursor.h"
#include "model/scene/readers.h"
#include "model/scene/strands.h"

namespace ctu::scene {
namespace {

constexpr std::uint32_t kHasSegments = 1, kHasPoints = 2, kHasThickness = 4, kKnownBits = 31;
constexpr std::size_t kHeaderBytes = 128;
constexpr const char* kDamaged = "the file is damaged or cut off: fetch or export it again";

struct HairHeader {
  std::uint32_t strands = 0, points = 0, bits = 0, segments = 0;
  float thickness = 0;
};

HairHeader read_header(const SourceFile& file) {
  if (file.bytes.size() < kHeaderBytes || !file.bytes.starts_with("HAIR"))
    throw Error(file.path, "is no .hair file: it does not start with 'HAIR' and a header of 128 bytes",
                "check the file's name");
  ByteCursor bytes(file, false, 4);
  HairHeader header;
  header.strands = bytes.take<std::uint32_t>("the header");
  header.points = bytes.take<std::uint32_t>("the header");
  header.bits = bytes.take<std::uint32_t>("the header");
  header.segments = bytes.take<std::uint32_t>("the header");
  header.thickness = bytes.take<float>("the header");
  if ((header.bits & kHasPoints) == 0) throw Error(file.path + ": byte 12", "the file holds no points", kDamaged);
  if ((header.bits & ~kKnownBits) != 0)
    throw Error(file.path + ": byte 12", fmt::format("unknown bits 0x{:x} in the header", header.bits), kDamaged);
  return header;
}

// Where each array begins; an array that is absent begins where the next one does.
struct HairArrays {
  std::size_t segments = kHeaderBytes, points = 0, thickness = 0;
};

HairArrays place_arrays(const SourceFile& file, const HairHeader& header) {
  HairArrays arrays;
  ByteCursor bytes(file, false, kHeaderBytes);
  const auto pass = [&](std::uint32_t bit, std::uint64_t count, std::uint64_t item_bytes, const char* what) {
    if ((header.bits & bit) == 0) return;
    bytes.expect(count, item_bytes, what);
    bytes.skip(count * item_bytes, what);
  };
  pass(kHasSegments, header.strands, 2, "strands");
  arrays.points = bytes.offset();
  pass(kHasPoints, header.points, 12, "points");
  arrays.thickness = bytes.offset();
  pass(kHasThickness, header.points, 4, "thicknesses");
  return arrays;
}

double width_here(const SourceFile& file, ByteCursor& thickness, const HairHeader& header, const Draft& draft) {
  const bool own = (header.bits & kHasThickness) != 0;
  const float stated = own ? thickness.take<float>("the thicknesses") : header.thickness;
  const float width = draft.options.strand_thickness > 0 ? draft.options.strand_thickness : stated;
  if (!std::isfinite(width) || width < 0)
    throw Error(own ? thickness.where() : file.path + ": byte 20", "a thickness is negative or not finite", kDamaged);
  return width;
}

}  // namespace

void read_hair(const SourceFile& file, Draft& draft) {
  draft.add_format("hair");
  const HairHeader header = read_header(file);
  const HairArrays arrays = place_arrays(file, header);
  ByteCursor segments(file, false, arrays.segments), points(file, false, arrays.points);
  ByteCursor thickness(file, false, arrays.thickness);
  require_room_for_strands(file.path, std::min(header.strands, header.points), header.points, draft);

  std::uint64_t points_left = header.points;
  std::vector<StrandPoint> strand;
  for (std::uint32_t n = 0; n < header.strands; ++n) {
    const std::uint64_t own = 1 + ((header.bits & kHasSegments) != 0 ? segments.take<std::uint16_t>("the segments")
                                                                     : std::uint64_t{header.segments});
    if (own < 2) throw Error(fmt::format("{}: strand {}", file.path, n), "has no segments", kDamaged);
    if (own > points_left)
      throw Error(fmt::format("{}: strand {}", file.path, n),
                  fmt::format("needs {} points, but only {} are left", own, points_left), kDamaged);
    points_left -= own;
    strand.clear();
    for (std::uint64_t i = 0; i < own; ++i) {
      StrandPoint p;
      p.position.x = points.take<float>("the points");
      p.position.y = points.take<float>("the points");
      p.position.z = points.take<float>("the points");
      p.width = width_here(file, thickness, header, draft);
      if (!std::isfinite(p.position.x + p.position.y + p.position.z))
        throw Error(fmt::format("{} (strand {})", points.where(), n), "a coordinate is NaN or infinite", kDamaged);
      strand.push_back(p);
    }
    append_strand(strand, n, file.path, draft);
  }
  if (points_left != 0)
    throw Error(file.path + ": byte 8", fmt::format("{} points belong to no strand", points_left), kDamaged);
}

}  // namespace ctu::scene
