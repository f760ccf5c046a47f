// AMD TressFX 4 .tfx: guide strands, all with the same number of vertices (x y z and an inverse mass).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model/base/error.h"
#include "model/scene/byte_cursor.h"
#include "model/scene/readers.h"
#include "model/scene/strands.h"

namespace ctu::scene {
namespace {

// The format stores no width. A two-thousandth of the diagonal is half a millimetre on a head with long hair.
constexpr double kWidthOfDiagonal = 1.0 / 2000;
constexpr std::uint64_t kVertexBytes = 16;
constexpr const char* kDamaged = "the file is damaged or cut off: fetch or export it again";

struct TfxHeader {
  std::uint32_t strands = 0, vertices_each = 0, offset = 0;
};

TfxHeader read_header(const SourceFile& file) {
  ByteCursor bytes(file);
  const auto version = bytes.take<float>("the header");
  if (!(version >= 4.0f && version < 5.0f))
    throw Error(file.path + ": byte 0", "is no TressFX 4 file: its version is not 4",
                "export it with the TressFX 4 exporter");
  TfxHeader header;
  header.strands = bytes.take<std::uint32_t>("the header");
  header.vertices_each = bytes.take<std::uint32_t>("the header");
  header.offset = bytes.take<std::uint32_t>("the header");
  if (header.vertices_each < 2) throw Error(file.path + ": byte 8", "strands with fewer than two vertices", kDamaged);
  if (header.offset < bytes.offset() || header.offset > file.bytes.size())
    throw Error(file.path + ": byte 12", fmt::format("the positions begin at byte {}", header.offset), kDamaged);
  return header;
}

Vector64 take_position(ByteCursor& bytes) {
  Vector64 p;
  p.x = bytes.take<float>("the positions");
  p.y = bytes.take<float>("the positions");
  p.z = bytes.take<float>("the positions");
  if (!std::isfinite(p.x + p.y + p.z)) throw Error(bytes.where(), "a coordinate is NaN or infinite", kDamaged);
  bytes.skip(4, "an inverse mass");
  return p;
}

double default_width(ByteCursor bytes, std::uint64_t vertices) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector64 lower{kInfinity, kInfinity, kInfinity}, upper{-kInfinity, -kInfinity, -kInfinity};
  for (std::uint64_t i = 0; i < vertices; ++i) {
    const Vector64 p = take_position(bytes);
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  return length(upper - lower) * kWidthOfDiagonal;
}

}  // namespace

void read_tfx(const SourceFile& file, Draft& draft) {
  draft.add_format("tfx");
  const TfxHeader header = read_header(file);
  ByteCursor bytes(file, false, header.offset);
  const std::uint64_t vertices = std::uint64_t{header.strands} * header.vertices_each;
  bytes.expect(vertices, kVertexBytes, "vertices");
  if (vertices == 0) return;
  require_room_for_strands(file.path, header.strands, vertices, draft);
  const double width =
      draft.options.strand_thickness > 0 ? draft.options.strand_thickness : default_width(bytes, vertices);
  std::vector<StrandPoint> strand(header.vertices_each);
  for (std::uint32_t n = 0; n < header.strands; ++n) {
    for (StrandPoint& point : strand) point = {take_position(bytes), width};
    append_strand(strand, n, file.path, draft);
  }
}

}  // namespace ctu::scene
