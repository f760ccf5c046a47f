#include "sim/tailor/gate_build.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "sim/area/unit_parameters.h"

namespace ctu::tailor {
namespace {

namespace fs = std::filesystem;

/// Parameters of the unit's source that a build is not given: they follow from others.
constexpr std::array<std::string_view, 2> kFollowing = {"MAX_HIT_LATENCY", "LOAD_BITS"};

fs::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0')
    return fs::path(cache) / "ctusim" / "rtl";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return fs::path(home) / ".cache" / "ctusim" / "rtl";
  return fs::temp_directory_path() / "ctusim-rtl";
}

std::string quoted(const fs::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void run(const std::string& command, const fs::path& log) {
  if (std::system((command + " >>" + quoted(log) + " 2>&1").c_str()) != 0)
    throw Error(log.string(), "the build of the unit in gates failed",
                "the file has the messages; cmake, ninja and verilator must be there, and the program's sources");
}

}  // namespace

area::RtlParameters gate_parameters(const pipeline::UnitConfig& config, const UnitParts& parts) {
  cull::MaskOptions masks;
  if (parts.r != 0) {
    masks.resolution = parts.r;
    masks.ray_resolution = parts.r_ray;
    masks.entries = parts.entries;
  }
  return area::unit_parameters(config, masks, fs::path(CTU_RTL_FOLDER) / "ctu_unit.sv",
                               {.box_bits = static_cast<std::uint32_t>(parts.box_bits),
                                .primitive_boxes = parts.primitive_boxes,
                                .spheres = parts.spheres,
                                .packet_entries = parts.packet_entries,
                                .trees = parts.trees});
}

std::string gate_build_line(const std::string& name, const pipeline::UnitConfig& config, const UnitParts& parts) {
  std::string line = fmt::format("ctu_rtl_build({}", name);
  const auto add = [&](const std::string& key, const auto& value) { line += fmt::format(" {} {}", key, value); };
  for (const auto& [key, value] : gate_parameters(config, parts)) {
    if (key == "DESIGN")
      add(key, cull::to_string(config.mask_test.design));
    else if (key == "ROWS")
      add(key, cull::to_string(config.mask_test.rows));
    else if (key != "MAX_LEAF_BYTES" && std::find(kFollowing.begin(), kFollowing.end(), key) == kFollowing.end() &&
             key != "STACK_ENTRIES" && key != "HAS_SPILLS")
      add(key, value);
  }
  int entries = 4;
  while (entries < config.stack.entries) entries *= 2;
  add("STACK_ENTRIES", entries);
  add("HAS_SPILLS", parts.spills ? 1 : 0);
  add("MAX_LEAF_BYTES", parts.leaf_bytes);
  return line + ")";
}

fs::path build_gates(const std::string& name, const std::string& line) {
  const std::string sources = fs::path(CTU_SOURCE_FOLDER).string();
  const fs::path folder = cache_folder() / hash_bytes(sources.data(), sources.size()).hex().substr(0, 12);
  const fs::path build = folder / "build", list = folder / (name + ".cmake"), log = folder / (name + ".log");
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  if (!(std::ofstream(list) << line << '\n'))
    throw Error(list.string(), "cannot be written", "set XDG_CACHE_HOME to a folder of yours");
  fs::remove(log, ignored);
  run(fmt::format("cmake -S {} -B {} -G Ninja -DCMAKE_BUILD_TYPE=Release -DCTU_RTL_BUILDS={}",
                  quoted(CTU_SOURCE_FOLDER), quoted(build), quoted(list)),
      log);
  run(fmt::format("cmake --build {} --target rtl_build_{}", quoted(build), name), log);
  return build / "rtl";
}

}  // namespace ctu::tailor
