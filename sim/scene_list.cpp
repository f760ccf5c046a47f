#include "sim/scene_list.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "sim/scene_args.h"

namespace ctu::sim {
namespace {

constexpr const char* kGenerated[] = {"gen:hair-ball",    "gen:curly-hair", "gen:straight-hair",
                                      "gen:tilted-quads", "gen:foliage",    "gen:tetra"};

struct View {
  const char *name, *eye, *target;
  double vertical_fov;
};
constexpr View kViews[] = {{"sponza", "-10,2,0", "10,4,0.5", 60}};

std::vector<ListedScene> read_index(const std::string& index) {
  constexpr std::uint64_t kMostBytes = 1u << 20;
  std::istringstream in(read_file(index, kMostBytes, "an index has a line NAME PATH for each scene"));
  const std::filesystem::path folder = std::filesystem::path(index).parent_path();
  std::vector<ListedScene> listed;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    ListedScene scene;
    if (!(words >> scene.name)) continue;
    if (!(words >> scene.path))
      throw Error(fmt::format("{}:{}", index, number), "a scene without a file", "write NAME PATH on each line");
    scene.path = (folder / scene.path).string();
    scene.named = false;
    listed.push_back(scene);
  }
  return listed;
}

}  // namespace

std::string short_name(const std::string& name) {
  if (name.rfind("gen:", 0) == 0) return name;
  const std::filesystem::path path(name);
  const std::string file = path.filename().string();
  const std::string stem = file.substr(0, file.find('.'));
  return stem == "scene" && path.has_parent_path() ? path.parent_path().filename().string() : stem;
}

std::vector<ListedScene> listed_scenes(const SceneArgs& args) {
  if (args.scenes.empty() && args.index.empty())
    throw Error("SCENE", "no scene is named", "name scenes, or give a list of them with --index FILE");
  std::vector<ListedScene> known;
  for (const char* name : kGenerated) known.push_back({name, name, false});
  if (!args.index.empty()) {
    const auto indexed = read_index(args.index);
    known.insert(known.end(), indexed.begin(), indexed.end());
  }
  if (args.scenes.empty()) return known;
  std::vector<ListedScene> wanted;
  for (const std::string& name : args.scenes) {
    const auto at = std::find_if(known.begin(), known.end(), [&](const ListedScene& k) { return k.name == name; });
    wanted.push_back({short_name(name), at == known.end() ? name : at->path, true});
  }
  return wanted;
}

SceneArgs with_default_index(SceneArgs args) {
  constexpr const char* kDefaultIndex = "build/scenes/index.txt";
  if (args.index.empty() && std::filesystem::exists(kDefaultIndex)) args.index = kDefaultIndex;
  return args;
}

SceneArgs with_default_scenes(SceneArgs args, const std::vector<std::string>& wanted) {
  if (!args.scenes.empty()) return args;
  const std::vector<ListedScene> listed = args.index.empty() ? std::vector<ListedScene>() : read_index(args.index);
  for (const std::string& name : wanted)
    if (name.rfind("gen:", 0) == 0 ||
        std::any_of(listed.begin(), listed.end(), [&](const ListedScene& scene) { return scene.name == name; }))
      args.scenes.push_back(name);
  return args;
}

SceneArgs with_view(const SceneArgs& args, const ListedScene& listed) {
  SceneArgs viewed = args;
  if (!args.eye.empty() || !args.target.empty() || args.vertical_fov != 0) return viewed;
  for (const View& view : kViews)
    if (listed.name == view.name) {
      viewed.eye = view.eye;
      viewed.target = view.target;
      viewed.vertical_fov = view.vertical_fov;
    }
  return viewed;
}

void require_triangles(const scene::Scene& scene) {
  if (!scene.mesh.spheres.empty())
    throw Error(scene.name, fmt::format("has {} spheres, which this command does not take", scene.mesh.spheres.size()),
                "name a scene of triangles");
}

std::optional<scene::Scene> load_listed(const SceneArgs& args, const ListedScene& listed, Primitives primitives) {
  try {
    scene::Scene scene = load_scene(with_view(args, listed), listed.path);
    if (primitives == Primitives::Triangles) require_triangles(scene);
    return scene;
  } catch (const Error& error) {
    if (listed.named) throw;
    fmt::print(stderr, "{} is left out: {}\n", listed.name, error.what());
    return std::nullopt;
  }
}

}  // namespace ctu::sim
