#include "model/cull/table_limit.h"

#include "model/base/error.h"

namespace ctu::cull {

void require_table_fits(std::string_view table, int ray_resolution, std::string_view content, std::uint64_t bytes,
                        std::string remedy) {
  if (bytes < kTableLimitBytes) return;
  throw Error(std::string(table) + ", R_ray = " + std::to_string(ray_resolution),
              std::string(content) + " take " + std::to_string(bytes >> 20) + " MiB, the limit is " +
                  std::to_string(kTableLimitBytes >> 20),
              std::move(remedy));
}

}  // namespace ctu::cull
