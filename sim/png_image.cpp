#include "sim/png_image.h"

#include <png.h>

#include <algorithm>
#include <cmath>

#include "model/base/error.h"

namespace ctu::sim {

PngImage::PngImage(int width, int height, Rgb background)
    : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, background) {}

void PngImage::write(const std::string& path) const {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&image, path.c_str(), 0, pixels_.data(), 0, nullptr) == 0)
    throw Error(path, std::string("the picture could not be written (") + image.message + ")",
                "check the folder and the free space");
}

Rgb heat_color(double share) {
  static constexpr double kStops[][3] = {{0, 0, 0},      {50, 10, 90},   {130, 30, 110}, {205, 60, 70},
                                         {245, 125, 20}, {250, 200, 50}, {255, 255, 230}};
  constexpr int kIntervals = static_cast<int>(std::size(kStops)) - 1;
  const double position = std::clamp(share, 0.0, 1.0) * kIntervals;
  const int i = std::min(static_cast<int>(position), kIntervals - 1);
  const double weight = position - i;
  Rgb color{};
  for (int c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(std::lround(kStops[i][c] * (1 - weight) + kStops[i + 1][c] * weight));
  return color;
}

}  // namespace ctu::sim
