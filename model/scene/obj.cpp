// Wavefront OBJ through tinyobjloader. The library accepts wrong indices, missing numbers and cut-off lines in silence,
// so a pass of ours over the lines comes first; it is also what knows the line numbers.
#include <tiny_obj_loader.h>

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "model/base/error.h"
#include "model/scene/readers.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {
namespace {

// The library cuts a face of n corners in up to n^3 steps.
constexpr int kMostCorners = 1024;

class ObjCheck {
 public:
  explicit ObjCheck(const SourceFile& file) : file_(file) {}

  void run() {
    std::string_view text = file_.bytes;
    while (!text.empty()) {
      const std::size_t end = text.find_first_of("\n\r");
      ++line_;
      check_line(text.substr(0, end));
      if (end == std::string_view::npos) break;
      const bool two = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
      text.remove_prefix(end + (two ? 2 : 1));
    }
    if (largest_ > vertices_) fail_index(largest_line_, std::to_string(largest_), vertices_);
  }

  /// Lines that the library would take for something else, or for more than they are.
  bool needs_blanks() const { return needs_blanks_; }
  /// Triangles that the faces make.
  std::uint64_t triangles() const { return triangles_; }

 private:
  static std::string_view next_word(std::string_view& line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) return line = {};
    const std::size_t last = std::min(line.find_first_of(" \t", first), line.size());
    const std::string_view word = line.substr(first, last - first);
    line.remove_prefix(last);
    return word;
  }

  void check_line(std::string_view line) {
    const std::string_view key = next_word(line);
    if (key == "v")
      check_vertex(line);
    else if (key == "f")
      check_face(line);
    else if (key == "t")
      needs_blanks_ = true;
    if (!line.empty() && line.back() == '\\' && (key == "v" || key == "f" || key == "l" || key == "p"))
      fail("continues on the next line ('\\')", "write the statement on one line: exporters have an option for it");
  }

  void check_vertex(std::string_view line) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = next_word(line);
      float value;
      if (!parse_number(word, value))
        fail(fmt::format("'{}' is not a finite binary32 number, where a coordinate should be", word.substr(0, 40)),
             "correct the line; a cut-off file must be fetched again");
    }
    ++vertices_;
  }

  void check_face(std::string_view line) {
    int corners = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      if (word.front() == '#') {
        needs_blanks_ = true;  // the library takes the comment for indices
        break;
      }
      if (word == "\\") return;
      const std::string_view number = word.substr(0, word.find('/'));
      std::int64_t index = 0;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
      if (error != std::errc{} || end != number.data() + number.size())
        fail(fmt::format("'{}' is not a vertex number", word.substr(0, 40)), "correct the line");
      if (index == 0 || index < -vertices_) fail_index(line_, std::string(number), vertices_);
      if (index > largest_) {
        largest_ = index;
        largest_line_ = line_;
      }
      ++corners;
    }
    if (corners > kMostCorners)
      fail(fmt::format("a face with {} corners; {} are possible", corners, kMostCorners),
           "cut it into triangles before exporting");
    if (corners < 3)
      fail(fmt::format("a face with {} corners", corners), "a face needs three; a cut-off file must be fetched again");
    triangles_ += static_cast<std::uint64_t>(corners) - 2;
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(fmt::format("{}:{}", file_.path, line_), problem, remedy);
  }
  [[noreturn]] void fail_index(std::uint64_t line, const std::string& index, std::int64_t vertices) const {
    throw Error(fmt::format("{}:{}", file_.path, line),
                fmt::format("names vertex {}, but there are {}", index, vertices),
                "vertices count from 1, or backwards from -1; the file is damaged or cut off");
  }

  const SourceFile& file_;
  bool needs_blanks_ = false;
  std::uint64_t triangles_ = 0;
  std::uint64_t line_ = 0, largest_line_ = 0;
  std::int64_t vertices_ = 0, largest_ = 0;
};

/// Blanks comments, and tags of subdivision surfaces ("t"): for twenty characters of one the library keeps up to 300
/// kB, which nobody reads.
std::string blanked(std::string text) {
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\n\r", line), text.size());
    const std::size_t word = std::min(text.find_first_not_of(" \t", line), end);
    const bool tag = word + 1 < end && text[word] == 't' && (text[word + 1] == ' ' || text[word + 1] == '\t');
    const std::size_t from = tag ? line : std::min(text.find('#', line), end);
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(from), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    line = end + 1;
  }
  return text;
}

void append_shape(const tinyobj::shape_t& shape, std::uint64_t base, std::uint64_t vertices, const std::string& where,
                  Draft& draft) {
  const auto& indices = shape.mesh.indices;
  draft.require_room(where, 0, indices.size() / 3);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const int index = indices[i + c].vertex_index;
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
        throw Error(where, fmt::format("names vertex {}, but there are {}", index + 1, vertices),
                    "the file is damaged");
      triangle[c] = static_cast<std::uint32_t>(base + static_cast<std::uint64_t>(index));
    }
    draft.mesh.triangles.push_back(triangle);
  }
}

}  // namespace

void read_obj(const SourceFile& file, Draft& draft) {
  draft.add_format("obj");
  ObjCheck check(file);
  check.run();
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(check.needs_blanks() ? blanked(file.bytes) : file.bytes, "", config))
    throw Error(file.path, fmt::format("is no OBJ file: {}", reader.Error()), "export it again");

  const auto& coordinates = reader.GetAttrib().vertices;
  const std::uint64_t base = draft.mesh.vertices.size(), vertices = coordinates.size() / 3;
  draft.require_room(file.path, vertices, 0);
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3)
    draft.mesh.vertices.push_back({coordinates[i], coordinates[i + 1], coordinates[i + 2]});
  const std::uint64_t triangles = draft.mesh.triangles.size();
  for (const tinyobj::shape_t& shape : reader.GetShapes()) append_shape(shape, base, vertices, file.path, draft);
  if (draft.mesh.triangles.size() - triangles < check.triangles())
    draft.warn("obj: a polygon that is flat or crosses itself gave fewer triangles than its corners ask for");
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    if (!shape.lines.indices.empty() || !shape.points.indices.empty())
      draft.warn("obj: lines and points are not triangles and were skipped");
}

}  // namespace ctu::scene
