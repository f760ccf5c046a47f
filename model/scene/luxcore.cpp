// LuxCore's .scn: a list of properties, of which the PLY files of the objects and the camera are read.
#include <fmt/core.h>

#include <filesystem>
#include <string_view>

#include "model/base/error.h"
#include "model/scene/readers.h"
#include "model/scene/resolve.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\"") - first + 1);
}

class LuxcoreReader {
 public:
  LuxcoreReader(const SourceFile& file, Draft& draft) : file_(file), text_(file, '#'), draft_(draft) {
    camera_.up = {0, 0, 1};
  }

  void run() {
    while (!text_.at_end()) {
      line_offset_ = text_.offset();
      const std::string_view line = text_.rest_of_line();
      const std::size_t equals = line.find('=');
      if (equals == std::string_view::npos) fail("is not 'key = value'", "correct the line");
      property(trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
    }
    if (has_eye_ && has_target_ && !draft_.camera) {
      camera_.from_file = true;
      draft_.camera = camera_;
    }
  }

 private:
  void property(std::string_view key, std::string_view value) {
    if (key == "scene.camera.lookat") {
      float numbers[6];
      parse_all(value, numbers, 6);
      camera_.eye = {numbers[0], numbers[1], numbers[2]};
      camera_.target = {numbers[3], numbers[4], numbers[5]};
      has_eye_ = has_target_ = true;
    } else if (key == "scene.camera.lookat.orig") {
      parse_all(value, &camera_.eye.x, 3);
      has_eye_ = true;
    } else if (key == "scene.camera.lookat.target") {
      parse_all(value, &camera_.target.x, 3);
      has_target_ = true;
    } else if (key == "scene.camera.up") {
      parse_all(value, &camera_.up.x, 3);
    } else if (key == "scene.camera.fieldofview") {
      parse_all(value, &camera_.vertical_fov_degrees, 1);
    } else if (key.starts_with("scene.objects.") || key.starts_with("scene.shapes.")) {
      if (key.ends_with(".ply")) return mesh(std::string(value));
      if (key.ends_with(".transformation"))
        fail("a transformed object; LuxCore transforms are not read", "bake it into the PLY");
    }
  }

  // Paths in a .scn begin at the folder that the program ran in; the files lie beside the .scn.
  void mesh(const std::string& name) {
    const std::filesystem::path path(name);
    std::error_code unreadable;
    const bool as_named = std::filesystem::is_regular_file(file_.folder / path, unreadable);
    const auto found =
        resolve(file_.folder, as_named ? name : path.filename().string(), text_.where(line_offset_), draft_);
    if (found) append_ply(read_source(*found), draft_);
  }

  void parse_all(std::string_view value, float* numbers, int count) {
    for (int i = 0; i < count; ++i) {
      value = trimmed(value);
      const std::size_t end = std::min(value.find_first_of(" \t"), value.size());
      if (!parse_number(value.substr(0, end), numbers[i]))
        fail(fmt::format("{} finite numbers expected", count), "correct the line");
      value.remove_prefix(end);
    }
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(text_.where(line_offset_).text(), problem, remedy);
  }

  const SourceFile& file_;
  TextCursor text_;
  Draft& draft_;
  Camera camera_;
  std::size_t line_offset_ = 0;
  bool has_eye_ = false, has_target_ = false;
};

}  // namespace

void read_luxcore(const SourceFile& file, Draft& draft) {
  draft.add_format("luxcore");
  LuxcoreReader(file, draft).run();
}

}  // namespace ctu::scene
