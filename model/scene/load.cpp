#include "model/scene/load.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "model/base/error.h"
#include "model/scene/draft.h"
#include "model/scene/generate.h"
#include "model/scene/readers.h"
#include "model/scene/resolve.h"
#include "model/scene/source_file.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {
namespace {

using Reader = void (*)(const SourceFile&, Draft&);

struct Format {
  const char* extension;
  Reader read;
};

constexpr Format kFormats[] = {
    {"obj", read_obj},   {"ply", read_ply}, {"gltf", read_gltf}, {"glb", read_glb},     {"pbrt", read_pbrt},
    {"hair", read_hair}, {"tfx", read_tfx}, {"nff", read_nff},   {"scn", read_luxcore},
};

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  for (const Format& format : kFormats)
    if (extension == format.extension) return format;
  throw Error(
      path.string(), fmt::format("'.{}' is no scene format we know", extension),
      "name a file of .obj .ply .gltf .glb .pbrt .scn .hair .tfx .nff (.zst behind it or not) or .list, or gen:NAME");
}

void read_list(const std::filesystem::path& path, Draft& draft) {
  const SourceFile list = read_source(path);
  TextCursor text(list, '#');
  while (!text.at_end()) {
    const std::size_t offset = text.offset();
    std::string line(text.rest_of_line());
    line.resize(line.find_last_not_of(" \t") + 1);
    const bool camera_only = line.starts_with("camera ");
    if (camera_only) line.erase(0, line.find_first_not_of(' ', 7));
    const Format& format = format_of(line);
    if (camera_only && format.read != read_pbrt)
      throw Error(text.where(offset).text(), "only a .pbrt can be read for its camera alone",
                  "leave out the word camera");
    const auto found = resolve(list.folder, line, text.where(offset), draft);
    if (!found) continue;
    SourceFile file = read_source(*found);
    file.folder = list.folder;
    camera_only ? read_pbrt_camera(file, draft) : format.read(file, draft);
  }
}

void read_file(const std::filesystem::path& path, Draft& draft) {
  if (extension_of(path) == "list") return read_list(path, draft);
  const Format& format = format_of(path);
  format.read(read_source(path), draft);
}

// The file's stem; many scenes are called "scene" and known by their folder.
std::string title_of(const std::filesystem::path& path) {
  const std::string stem = stem_of(path), folder = path.parent_path().filename().string();
  return stem == "scene" && !folder.empty() ? folder : stem;
}

// One path, or several joined by commas. A file whose own name has a comma is taken as it is.
std::vector<std::string> parts_of(const std::string& name) {
  std::error_code unreadable;
  if (std::filesystem::exists(name, unreadable)) return {name};
  std::vector<std::string> parts;
  for (std::size_t first = 0; first <= name.size();) {
    const std::size_t comma = std::min(name.find(',', first), name.size());
    parts.push_back(name.substr(first, comma - first));
    first = comma + 1;
  }
  return parts;
}

/// The time that a match takes grows as the name's length to the number of stars.
void check_patterns(const std::vector<std::string>& patterns, const std::string& where) {
  constexpr std::ptrdiff_t kMostStars = 3;
  for (const std::string& pattern : patterns)
    if (std::count(pattern.begin(), pattern.end(), '*') > kMostStars)
      throw Error(where, fmt::format("the pattern '{}' has more than {} stars", pattern, kMostStars),
                  "give several patterns instead");
}

}  // namespace

Scene load(const std::string& name, const LoadOptions& options) {
  check_patterns(options.without, name);
  Draft draft;
  draft.options = options;
  if (name.starts_with(kGeneratorPrefix)) {
    generate(name, draft);
    return finish(std::move(draft), name, name);
  }
  std::string title;
  for (const std::string& part : parts_of(name)) {
    read_file(part, draft);
    if (!title.empty()) title += '+';
    title += title_of(part);
  }
  return finish(std::move(draft), title, name);
}

}  // namespace ctu::scene
