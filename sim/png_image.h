// An 8-bit RGB picture and its PNG file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ctu::sim {

using Rgb = std::array<std::uint8_t, 3>;

class PngImage {
 public:
  PngImage(int width, int height, Rgb background = {0, 0, 0});
  int width() const { return width_; }
  int height() const { return height_; }
  void set(int x, int y, Rgb color) { pixels_[static_cast<std::size_t>(y) * width_ + x] = color; }

  /// Error when the file cannot be written.
  void write(const std::string& path) const;

 private:
  int width_, height_;
  std::vector<Rgb> pixels_;
};

/// A perceptually even dark-to-bright scale (black, violet, red, orange, yellow, white); `share` is clamped to [0, 1].
Rgb heat_color(double share);

}  // namespace ctu::sim
