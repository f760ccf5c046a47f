#include "sim/loaded_trace.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::sim {

LoadedTrace::LoadedTrace(const std::string& path) : reader_(path) {
  const accel::Image image = reader_.read_image();
  bvh_ = accel::decode(image);
  set_.lut = reader_.compression();
  set_.masks = traces::masks_of(image, mask_options(), set_.lut.get());
}

cull::MaskTester LoadedTrace::tester(cull::Design design) const {
  if (design != cull::Design::None && set_.masks.bits.empty())
    throw Error(reader_.path(), fmt::format("carries no masks, and {} asks them", to_string(design)),
                "run it with mask_test.design=none, or record it with --culling on");
  return cull::MaskTester(design, mask_options(), set_.lut);
}

accel::Image LoadedTrace::unit_image(cull::Design design) const {
  return traces::image_of(bvh_, design == cull::Design::None ? nullptr : &set_, reader_.manifest().image.shape.layout);
}

traces::RayRange LoadedTrace::range(std::uint64_t first, std::uint64_t count) const {
  if (reader_.rays() == 0) throw Error(reader_.path(), "holds no rays", "record it with more pixels or samples");
  if (first >= reader_.rays())
    throw Error(reader_.path(), fmt::format("there is no ray {}", first),
                fmt::format("the trace holds rays 0 to {}", reader_.rays() - 1));
  const std::uint64_t rest = reader_.rays() - first;
  return {first, first + (count == 0 ? rest : std::min(count, rest))};
}

}  // namespace ctu::sim
