// `ctusim heatmap`: intersections of each pixel's camera rays without culling (left) and with it (right), the paper's
// Fig. 1.
#include <algorithm>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/base/parallel.h"
#include "model/cull/mask_test.h"
#include "model/reference/traversal.h"
#include "sim/commands.h"
#include "sim/png_image.h"
#include "sim/scene_args.h"
#include "traces/mask_set.h"
#include "traces/ray_generator.h"

namespace ctu::sim {
namespace {

using cull::Design;

/// Intersections of each pixel, averaged over its samples, row by row from the top.
std::vector<float> count_pixels(const traces::RayGenerator& generator, const reference::Traversal& traversal,
                                int threads) {
  const auto& rays = generator.options();
  std::vector<float> counts(static_cast<std::size_t>(rays.width) * rays.height);
  parallel_chunks(rays.height, 1, threads, [&](std::size_t first_row, std::size_t last_row) {
    for (std::size_t y = first_row; y < last_row; ++y)
      for (std::uint32_t x = 0; x < rays.width; ++x) {
        reference::StepList steps;
        for (std::uint32_t sample = 0; sample < rays.samples_per_pixel; ++sample)
          traversal.trace(generator.primary_ray(x, static_cast<std::uint32_t>(y), sample), &steps);
        counts[y * rays.width + x] = static_cast<float>(count_steps(steps, 0, steps.rays()).intersections_per_ray());
      }
  });
  return counts;
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// The value that 99 of 100 pixels do not exceed.
double bright_end(std::vector<float> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), place, values.end());
  return std::max(1.0, static_cast<double>(*place));
}

/// Two pictures side by side over a scale from 0 to the bright end.
PngImage draw(const std::vector<float>& left, const std::vector<float>& right, int width, int height, double range) {
  constexpr int kGap = 4, kScaleHeight = 12;
  PngImage image(2 * width + kGap, height + kGap + kScaleHeight, {255, 255, 255});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      image.set(x, y, heat_color(left[i] / range));
      image.set(width + kGap + x, y, heat_color(right[i] / range));
    }
  for (int y = height + kGap; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) image.set(x, y, heat_color(static_cast<double>(x) / (image.width() - 1)));
  return image;
}

}  // namespace

int heatmap_command(const HeatmapArgs& args) {
  SceneArgs scene_args = args.scene;
  scene_args.rays = "primary";
  const traces::RecordOptions options = record_options(scene_args);
  const auto designs = parse_designs(args.design);
  if (designs.size() != 1) throw Error("--design", "one design fits into the picture", "give one name");
  require_possible(designs.front(), options.masks);

  const scene::Scene scene = load_scene(scene_args, scene_args.scenes.front());
  const accel::Bvh4 bvh = accel::build(scene.mesh, options.build);
  const traces::MaskSet set = traces::make_masks(bvh, options.masks, options.threads);
  const traces::RayGenerator generator(scene, options.rays);
  const cull::MaskTester none(Design::None, options.masks), culling(designs.front(), options.masks, set.lut);
  const auto without = count_pixels(generator, reference::Traversal(bvh, nullptr, none), options.threads);
  const auto with = count_pixels(generator, reference::Traversal(bvh, &set.masks, culling), options.threads);

  const double range = args.range != 0 ? args.range : bright_end(without);
  draw(without, with, static_cast<int>(options.rays.width), static_cast<int>(options.rays.height), range)
      .write(args.output);
  fmt::print(
      "{}: intersections per primary ray {:.2f} without culling (left), {:.2f} with {} (right): {:.1f} %; scale 0 to "
      "{:.0f}\n",
      args.output, mean(without), mean(with), args.design, 100 * mean(with) / mean(without), range);
  return 0;
}

}  // namespace ctu::sim
