// Eric Haines' Neutral File Format: polygons, spheres and the view.
#include <fmt/core.h>

#include <cmath>
#include <string_view>

#include "model/base/error.h"
#include "model/scene/readers.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {
namespace {

// Lines matter only for l, f, b and the like, whose tails vary and are passed over; all else is counted numbers.
class NffReader {
 public:
  NffReader(const SourceFile& file, Draft& draft) : text_(file, '#'), draft_(draft) {}

  void run() {
    while (!text_.at_end()) statement(text_.word("a statement"));
    if (has_eye_ && has_target_ && !draft_.camera) {
      camera_.from_file = true;
      draft_.camera = camera_;
    }
  }

 private:
  void statement(std::string_view key) {
    if (key == "p" || key == "pp") return polygon(key == "pp");
    if (key == "from") return has_eye_ = true, point(camera_.eye);
    if (key == "at") return has_target_ = true, point(camera_.target);
    if (key == "up") return point(camera_.up);
    if (key == "angle") return angle();
    if (key == "v") return;
    if (key == "b" || key == "l" || key == "f" || key == "hither" || key == "resolution")
      return static_cast<void>(text_.rest_of_line());
    if (key == "s") return sphere();
    if (key == "c")
      text_.fail("a cone or cylinder; they are not read", "load a scene of polygons and spheres, or convert it");
    text_.fail(fmt::format("unknown statement '{}'", key.substr(0, 40)), "NFF knows v b l f p pp s c");
  }

  void point(Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) value[axis] = text_.number("a coordinate");
  }

  void angle() {
    camera_.vertical_fov_degrees = text_.number("an angle");
    if (!(camera_.vertical_fov_degrees > 0 && camera_.vertical_fov_degrees < 180))
      text_.fail("a field of view outside (0, 180) degrees", "correct the line");
  }

  // A negative radius turns the visible side inward; here both sides are hit.
  void sphere() {
    const Place where = text_.where();
    Sphere sphere;
    point(sphere.centre);
    sphere.radius = std::fabs(text_.number("a radius"));
    draft_.require_room_for_spheres(where, 1);
    draft_.mesh.spheres.push_back(sphere);
  }

  void polygon(bool has_normals) {
    const std::int64_t corners = text_.integer("a polygon's number of corners");
    const std::int64_t least_bytes = has_normals ? 12 : 6;  // a digit and a space for every number
    if (corners < 3 || corners > static_cast<std::int64_t>(text_.bytes_left() + 1) / least_bytes)
      text_.fail(fmt::format("a polygon with {} corners", corners), "three or more, and as many lines behind it");
    const auto count = static_cast<std::uint64_t>(corners);
    draft_.require_room(text_.where(), count, count - 2);
    const auto first = static_cast<std::uint32_t>(draft_.mesh.vertices.size());
    for (std::uint64_t i = 0; i < count; ++i) {
      Vec3 vertex, normal;
      point(vertex);
      if (has_normals) point(normal);
      draft_.mesh.vertices.push_back(vertex);
    }
    for (std::uint32_t i = 2; i < count; ++i) draft_.mesh.triangles.push_back({first, first + i - 1, first + i});
  }

  TextCursor text_;
  Draft& draft_;
  Camera camera_;
  bool has_eye_ = false, has_target_ = false;
};

}  // namespace

void read_nff(const SourceFile& file, Draft& draft) {
  draft.add_format("nff");
  NffReader(file, draft).run();
}

}  // namespace ctu::scene
