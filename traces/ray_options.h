// Which rays a trace holds. With the scene it decides every ray, bit for bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "model/numeric/vec3.h"

namespace ctu::traces {

struct RayOptions {
  enum class Rays : std::uint8_t {
    Primary,  ///< pinhole camera of the scene
    Diffuse,  ///< paths: a primary ray, then cosine-weighted bounces until a miss
    Shadow,   ///< any-hit, from every primary hit to one point light
    Ao,       ///< any-hit, from every primary hit, cosine-weighted, of limited length
    Random,   ///< closest-hit, isotropic lines through the sphere around the scene
  };
  Rays kind = Rays::Primary;
  std::uint32_t width = 256, height = 256;  ///< pixels
  std::uint32_t samples_per_pixel = 1;
  std::uint32_t bounces = 4;  ///< Diffuse: segments after the primary one, at most
  std::uint64_t seed = 1;
  bool skip_primary = false;  ///< Diffuse: leave the primary rays out of the trace
  bool jitter = true;         ///< false: every sample goes through the centre of its pixel
  bool tiled = false;         ///< pixels in tiles of 8x8 instead of rows
  std::uint64_t count = 0;    ///< Random: rays; 0: width * height * samples_per_pixel
  std::optional<Vec3> light;  ///< Shadow: position; none: default_light()
  float ao_radius = 0.1f;     ///< Ao: length of the rays, as a fraction of the scene's diagonal
  bool operator==(const RayOptions&) const = default;
};

/// "primary", "diffuse", "shadow", "ao", "random".
std::string_view to_string(RayOptions::Rays kind);
std::optional<RayOptions::Rays> rays_from_string(std::string_view name);

/// Throws Error naming the option that is out of range.
void check(const RayOptions& options);

}  // namespace ctu::traces
