// What a ray table may take of this machine's memory; asked before a table is allocated.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ctu::cull {

inline constexpr std::uint64_t kTableLimitBytes = std::uint64_t{1} << 30;  ///< a table must stay below

/// Throws Error{"`table`, R_ray = ...", "`content` take ... MiB", `remedy`} when `bytes` reach the limit.
void require_table_fits(std::string_view table, int ray_resolution, std::string_view content, std::uint64_t bytes,
                        std::string remedy);

}  // namespace ctu::cull
