#include "sim/area/area_cache.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ctu::area {
namespace {

using nlohmann::json;

std::filesystem::path users_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0')
    return std::filesystem::path(cache) / "ctusim" / "area";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return std::filesystem::path(home) / ".cache" / "ctusim" / "area";
  return std::filesystem::temp_directory_path() / "ctusim-area-cache";
}

json to_json(const PortPaths& paths) {
  json pass = json::array();
  for (const auto& [ports, gates] : paths.pass) pass.push_back({ports.first, ports.second, gates});
  return {{"inside", paths.inside},
          {"capture", paths.capture},
          {"launch", paths.launch},
          {"pass", pass},
          {"has_loops", paths.has_loops}};
}

PortPaths paths_from(const json& value) {
  PortPaths paths;
  paths.inside = value.at("inside").get<int>();
  paths.capture = value.at("capture").get<std::map<std::string, int>>();
  paths.launch = value.at("launch").get<std::map<std::string, int>>();
  for (const json& pass : value.at("pass"))
    paths.pass[{pass.at(0).get<std::string>(), pass.at(1).get<std::string>()}] = pass.at(2).get<int>();
  paths.has_loops = value.at("has_loops").get<bool>();
  return paths;
}

json to_json(const ModuleArea& area) {
  json memories = json::array();
  for (const auto& [shape, count] : area.memories)
    memories.push_back({shape.words, shape.width, shape.read_ports, shape.write_ports, count});
  return {{"cells", area.cells}, {"memories", memories}, {"instances", area.instances}, {"paths", to_json(area.paths)}};
}

ModuleArea area_from(const json& value) {
  using Counts = std::map<std::string, std::uint64_t>;
  ModuleArea area;
  area.cells = value.at("cells").get<Counts>();
  for (const json& memory : value.at("memories"))
    area.memories[{memory.at(0).get<std::uint64_t>(), memory.at(1).get<std::uint32_t>(),
                   memory.at(2).get<std::uint32_t>(), memory.at(3).get<std::uint32_t>()}] =
        memory.at(4).get<std::uint64_t>();
  area.instances = value.at("instances").get<Counts>();
  area.paths = paths_from(value.at("paths"));
  return area;
}

template <class Value, class From>
std::optional<Value> read_json(const std::filesystem::path& file, const From& from) {
  std::ifstream in(file);
  if (!in) return std::nullopt;
  try {
    return from(json::parse(in));
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

AreaCache::AreaCache(const std::filesystem::path& folder) : folder_(folder.empty() ? users_folder() : folder) {}

std::optional<ModuleArea> AreaCache::find(const std::string& key) const {
  return read_json<ModuleArea>(file(key), area_from);
}

void AreaCache::keep(const std::string& key, const ModuleArea& area) const { write(key, to_json(area).dump()); }

std::optional<AreaCache::Identities> AreaCache::find_identities(const std::string& key) const {
  return read_json<Identities>(file(key), [](const json& value) { return value.get<Identities>(); });
}

void AreaCache::keep_identities(const std::string& key, const Identities& identities) const {
  write(key, json(identities).dump());
}

void AreaCache::write(const std::string& key, const std::string& text) const {
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  // Under another name first: whoever reads at the same time sees all of it or nothing.
  const std::filesystem::path half = folder_ / fmt::format("{}.{}", key, getpid());
  if (!(std::ofstream(half) << text << '\n')) return;
  std::filesystem::rename(half, file(key), ignored);
}

}  // namespace ctu::area
