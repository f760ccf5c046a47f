#include "model/scene/load.h"

#include <fmt/core.h>

#include <filesystem>
#include <string_view>

#include "model/base/error.h"
#include "model/scene/draft.h"
#include "model/scene/generate.h"
#include "model/scene/readers.h"
#include "model/scene/source_file.h"

namespace ctu::scene {
namespace {

using Reader = void (*)(const SourceFile&, Draft&);

struct Format {
  const char* extension;
  Reader read;
};

constexpr Format kFormats[] = {
    {"obj", read_obj},
    {"ply", read_ply},
};

void read_file(const std::filesystem::path& path, Draft& draft) {
  const std::string extension = extension_of(path);
  for (const Format& format : kFormats)
    if (extension == format.extension) return format.read(read_source(path), draft);
  throw Error(path.string(), fmt::format("'.{}' is no scene format we know", extension),
              "name a file of .obj .ply .gltf .glb .pbrt .scn .hair .tfx .nff .list, or gen:NAME");
}

}  // namespace

Scene load(const std::string& name, const LoadOptions& options) {
  Draft draft;
  draft.options = options;
  if (name.starts_with(kGeneratorPrefix)) {
    generate(name, draft);
    return finish(std::move(draft), name, name);
  }
  read_file(name, draft);
  return finish(std::move(draft), stem_of(name), name);
}

}  // namespace ctu::scene
