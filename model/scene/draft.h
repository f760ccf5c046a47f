// A scene while it is read: every reader appends to one draft, and finish() checks the whole.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/scene/load.h"
#include "model/scene/place.h"
#include "model/scene/scene.h"

namespace ctu::scene {

/// The most triangles and spheres a scene may have (what a leaf reference can name) and the most vertices that go with
/// them.
inline constexpr std::uint64_t kMostTriangles = (std::uint64_t{1} << 27) - 1;
inline constexpr std::uint64_t kMostVertices = 3 * kMostTriangles;

struct Draft {
  LoadOptions options;
  Mesh mesh;
  LoadReport report;
  std::optional<Camera> camera;  ///< the first that a file states

  /// Counts a warning; equal ones become one line with their number.
  void warn(const std::string& text, std::uint64_t times = 1);
  /// Notes the format of one more file; several formats are joined by '+'.
  void add_format(const std::string& format);
  /// Makes room for that many more, which a reader knows to be in its file; throws Error at `where` if the scene would
  /// get too large.
  void require_room(const Place& where, std::uint64_t vertices, std::uint64_t triangles);
  void require_room_for_spheres(const Place& where, std::uint64_t spheres);

  /// Whether options.without says so for a file that the scene names; counts it.
  bool leaves_out(const std::string& file);

  std::vector<std::pair<std::string, std::uint64_t>> warnings;
  std::vector<std::uint64_t> left_out;  ///< files, for each pattern of options.without; empty: none so far
};

/// Checks what no reader may get wrong (at least one primitive, indices in range, vertices and spheres finite), counts
/// triangles without area, and adds bounds and camera. `where` is what the messages name.
Scene finish(Draft&& draft, const std::string& name, const std::string& where);

}  // namespace ctu::scene
