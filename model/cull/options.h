// What decides which boxes are culled. With the image and the ray it decides a ray's whole event sequence
// (contract 3); table sizes' timing, banks and the like belong to the unit's configuration instead.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace ctu::cull {

/// How the unit asks "does the ray touch an occupied cell of this box?" (DESIGN section 4).
enum class Design : std::uint8_t {
  None,         ///< it does not ask
  Ideal,        ///< grid traversal; software only, the bound on what culling can give (paper 4.1)
  MaskLut,      ///< ray-mask table of R_ray^6 entries (paper 3.1)
  Projection,   ///< three 2-D tables; the same masks as MaskLut, bit for bit
  Comparators,  ///< no table: the cells from the slab test's own times
};

/// "none", "ideal", "mask-lut", "projection", "comparators".
std::string_view to_string(Design design);
std::optional<Design> design_from_string(std::string_view name);

/// Cells whose rays have the same mask bits visit the same nodes: Projection shares MaskLut's events.
constexpr Design event_class(Design design) { return design == Design::Projection ? Design::MaskLut : design; }

inline constexpr int kMinResolution = 2, kMaxResolution = 8;
inline constexpr int kMaxRayResolution = 16;
inline constexpr int kUnlimitedLevels = 0, kMaxLevels = 64;  // the paper measures L = 1..5

struct MaskOptions {
  int resolution = 4;             ///< R: cells per axis of an object mask
  int ray_resolution = 4;         ///< R_ray: cells per axis of the ray's key; need not be a multiple of R
  int levels = kUnlimitedLevels;  ///< L: object masks from nodes L levels below (paper 3.2.1); 0: from all triangles
  bool operator==(const MaskOptions&) const = default;
};

/// Throws ctu::Error when R, R_ray or L is outside what the tables and keys can hold.
void validate(const MaskOptions& options);

/// 64-bit words that R^3 bits need.
constexpr int words_per_mask(int resolution) { return (resolution * resolution * resolution + 63) / 64; }

/// Bit of cell (x, y, z) in a mask of resolution R.
constexpr int cell_bit(int resolution, int x, int y, int z) { return x + resolution * (y + resolution * z); }

}  // namespace ctu::cull
