#include "model/scene/resolve.h"

#include <fmt/core.h>

#include <fstream>

#include "model/base/error.h"

namespace ctu::scene {
namespace {

bool is_listed_missing(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path path = folder / "MISSING.txt";
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return false;
  std::ifstream list(path);
  for (std::string line; std::getline(list, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line == name) return true;
  }
  return false;
}

}  // namespace

std::optional<std::filesystem::path> resolve(const std::filesystem::path& folder, const std::string& name,
                                             const Place& where, Draft& draft) {
  if (draft.leaves_out(name)) return std::nullopt;
  const std::filesystem::path above = folder.empty() ? ".." : folder / "..";
  std::error_code unreadable;
  for (const auto& candidate : {folder, above})
    if (std::filesystem::is_regular_file(candidate / name, unreadable)) return candidate / name;
  if (is_listed_missing(folder, name) || is_listed_missing(above, name)) {
    draft.warn(fmt::format("{} is not there and was left out: MISSING.txt lists it", name));
    return std::nullopt;
  }
  throw Error(where.text(), fmt::format("names '{}', which is not in {}", name, folder.empty() ? "." : folder.string()),
              "put the file there, or list it in a MISSING.txt beside the scene to leave it out");
}

}  // namespace ctu::scene
