#include "sim/loaded_trace.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::sim {

LoadedTrace::LoadedTrace(const std::string& path) : reader_(path) {
  const accel::Image image = reader_.read_image();
  bvh_ = accel::decode(image);
  masks_ = traces::masks_of(image, reader_.manifest().masks);
}

accel::Image LoadedTrace::unit_image(cull::Design design) const {
  accel::ImageLayout layout = reader_.manifest().image.shape.layout;
  if (design == cull::Design::None) layout.mask_bits = 0;
  return accel::make_image(bvh_, masks_.bits.data(), masks_.words, layout);
}

traces::RayRange LoadedTrace::range(std::uint64_t first, std::uint64_t count) const {
  if (first >= reader_.rays())
    throw Error(reader_.path(), fmt::format("there is no ray {}", first),
                fmt::format("the trace holds rays 0 to {}", reader_.rays() - 1));
  const std::uint64_t rest = reader_.rays() - first;
  return {first, first + (count == 0 ? rest : std::min(count, rest))};
}

}  // namespace ctu::sim
