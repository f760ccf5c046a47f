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
  BitTable,     ///< ray-mask index x compression index -> 1 bit (paper 3.2.2); needs compressed object masks
  Dedup,        ///< key -> number of its distinct ray mask -> mask, or bit row when object masks are compressed
  Projection,   ///< three 2-D tables; the same masks as MaskLut, bit for bit
  Comparators,  ///< no table: the cells from the slab test's own times
};

/// "none", "ideal", "mask-lut", "bit-table", "dedup", "projection", "comparators".
std::string_view to_string(Design design);
std::optional<Design> design_from_string(std::string_view name);

/// Designs whose rays have the same mask bits visit the same nodes: BitTable, Dedup and Projection share MaskLut's
/// events.
constexpr Design event_class(Design design) {
  return design == Design::BitTable || design == Design::Dedup || design == Design::Projection ? Design::MaskLut
                                                                                               : design;
}
/// Whether the design reads tables by the ray's key.
constexpr bool reads_tables(Design design) { return event_class(design) == Design::MaskLut; }

inline constexpr int kMinResolution = 2, kMaxResolution = 8;
inline constexpr int kMaxRayResolution = 3 * kMaxResolution;
inline constexpr int kMinEntries = 16, kMaxEntries = 4096;   ///< of a compression LUT
inline constexpr int kUnlimitedLevels = 0, kMaxLevels = 64;  // the paper measures L = 1..5

/// How the entries of a compression LUT are chosen (mask_selection.h).
enum class Selection : std::uint8_t {
  TopPerNode,  ///< the masks of the most important children (paper 3.2.2)
  TopSummed,   ///< the same with importance summed over equal masks
  Refined,     ///< ours: entries need not be masks of the scene
};

/// "top-per-node", "top-summed", "refined".
std::string_view to_string(Selection selection);
std::optional<Selection> selection_from_string(std::string_view name);

struct MaskOptions {
  int resolution = 4;             ///< R: cells per axis of an object mask
  int ray_resolution = 4;         ///< R_ray: cells per axis of the ray's key; need not be a multiple of R
  int levels = kUnlimitedLevels;  ///< L: object masks from nodes L levels below (paper 3.2.1); 0: from all triangles
  int entries = 0;                ///< of the compression LUT, the full mask included; 0: masks are not compressed
  Selection selection = Selection::Refined;  ///< of these entries
  bool operator==(const MaskOptions&) const = default;
};

/// Throws ctu::Error when R, R_ray, L or the number of entries is outside what the tables and keys can hold, or
/// R_ray < R.
void validate(const MaskOptions& options);

/// The same for what object masks depend on: all but R_ray.
void validate_object_masks(const MaskOptions& options);

/// 64-bit words that R^3 bits need.
constexpr int words_per_mask(int resolution) { return (resolution * resolution * resolution + 63) / 64; }

/// Bit of cell (x, y, z) in a mask of resolution R.
constexpr int cell_bit(int resolution, int x, int y, int z) { return x + resolution * (y + resolution * z); }

}  // namespace ctu::cull
