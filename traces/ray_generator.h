// Makes the rays of a trace from a scene. Every random number depends on (seed, pixel, sample, bounce) alone, so the
// rays are the same for any number of threads and any cut into pieces.
//
// A path is one sample of one pixel (or one random line); its rays follow each other in the trace, and paths follow in
// the order pixel, sample. Secondary rays start on the triangle at the recorded barycentric coordinates, or on the
// sphere nearest to the ray's point at the recorded t, moved along the geometric normal, on the side that the arriving
// ray came from, by 2^-19 of the largest coordinate in sight (16 units in the last place): more than the rounding of
// the origin, so a ray never meets the triangle or sphere that it leaves. tmin is 0.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"
#include "traces/ray_options.h"
#include "traces/sampling.h"

namespace ctu::traces {

/// The closest (or any) hit of a ray; `recorded` says whether the ray goes into the trace or only leads to others.
using TraceRay = std::function<intersect::Hit(const intersect::Ray& ray, bool recorded)>;

class RayGenerator {
 public:
  /// The scene must outlive this. Throws Error on options out of range.
  RayGenerator(const scene::Scene& scene, const RayOptions& options);

  const RayOptions& options() const { return options_; }
  std::uint64_t paths() const { return paths_; }
  std::uint32_t max_rays_per_path() const;

  /// Appends the rays of paths [first, last) and what each found.
  void generate(std::uint64_t first, std::uint64_t last, const TraceRay& trace, std::vector<intersect::Ray>& rays,
                std::vector<intersect::Hit>& hits) const;

  /// The camera ray of a sample of the pixel in column x, row y (row 0 at the top).
  intersect::Ray primary_ray(std::uint32_t x, std::uint32_t y, std::uint32_t sample) const;

 private:
  struct Basis {  // right and up span the picture at distance 1: pixel centres lie in (-1, 1) times their lengths
    Vec3d forward, right, up;
  };

  void walk_path(std::uint64_t path, const TraceRay& trace, std::vector<intersect::Ray>& rays,
                 std::vector<intersect::Hit>& hits) const;
  intersect::Ray random_line(std::uint64_t index) const;
  intersect::Ray secondary(const intersect::Ray& arriving, const intersect::Hit& hit, std::uint64_t pixel,
                           std::uint32_t sample, std::uint32_t bounce) const;

  const scene::Scene& scene_;
  RayOptions options_;
  std::uint64_t paths_ = 0;
  Basis basis_;
  Vec3 light_;
  double diagonal_ = 0;
};

/// Where a secondary ray leaves a surface, and its normal there, of length 1 and on the side of the ray that arrived.
struct Departure {
  Vec3d point, normal;
};
Departure depart(const scene::Mesh& mesh, const intersect::Ray& arriving, const intersect::Hit& hit);

/// The light of scenes for which none is given: over the centre of the box, as `up` of the camera is nearest to an
/// axis, three quarters of the diagonal high when the camera stands outside; just under the top of the box when it
/// stands inside, as in a room.
Vec3 default_light(const scene::Scene& scene);

}  // namespace ctu::traces
