#include "model/scene/pbrt_matrix.h"

#include <fmt/core.h>

#include <array>

namespace ctu::scene {
namespace {

constexpr std::size_t kDeepestStack = 100'000;
constexpr const char* kCorrect = "correct the line";

Affine matrix(PbrtText& text) {
  std::array<double, 16> numbers;
  text.numbers(numbers.data(), 16, "a matrix");
  const auto result = from_columns(numbers);
  if (!result) text.fail("the matrix is a projection: its numbers 4, 8, 12, 16 are not 0 0 0 1", kCorrect);
  return *result;
}

Vector64 vector(PbrtText& text) {
  double v[3];
  text.numbers(v, 3, "a vector");
  return {v[0], v[1], v[2]};
}

}  // namespace

const std::vector<std::string>& PbrtMatrix::statements() {
  static const std::vector<std::string> names = {
      "Identity", "Transform", "ConcatTransform",  "Translate",         "Scale",
      "Rotate",   "LookAt",    "CoordinateSystem", "CoordSysTransform", "ActiveTransform"};
  return names;
}

bool PbrtMatrix::take(std::string_view name, PbrtText& text) {
  if (name == "Identity") return set(Affine{}), true;
  if (name == "Transform") return set(matrix(text)), true;
  if (name == "ConcatTransform") return move(matrix(text)), true;
  if (name == "Translate") return move(translation(vector(text))), true;
  if (name == "Scale") return move(scaling(vector(text))), true;
  if (name == "Rotate") return rotate(text), true;
  if (name == "LookAt") return look_at(text), true;
  if (name == "CoordinateSystem") return remember(std::string(text.quoted("a name")), current_), true;
  if (name == "CoordSysTransform") return coordinate_system(text), true;
  if (name == "ActiveTransform") return active_transform(text), true;
  return false;
}

void PbrtMatrix::push(const PbrtText& text) {
  if (stack_.size() >= kDeepestStack) text.fail("blocks are nested too deep", kCorrect);
  stack_.push_back(current_);
}

void PbrtMatrix::pop(const PbrtText& text) {
  if (stack_.empty()) text.fail("ends a block that was not begun", "remove it, or add the Begin");
  current_ = stack_.back();
  stack_.pop_back();
}

void PbrtMatrix::begin_world() {
  current_ = Affine{};
  at_start_ = true;
  remember("world", current_);
}

void PbrtMatrix::set(const Affine& matrix) {
  if (at_start_) current_ = matrix;
}

void PbrtMatrix::move(const Affine& matrix) {
  if (at_start_) current_ = current_ * matrix;
}

void PbrtMatrix::rotate(PbrtText& text) {
  double v[4];
  text.numbers(v, 4, "an angle and an axis");
  const auto turned = rotation(v[0], {v[1], v[2], v[3]});
  if (!turned) text.fail("rotates about a zero axis", kCorrect);
  move(*turned);
}

// World to camera: x = up cross direction, as pbrt has it (left-handed), y = the true up, z = the direction.
void PbrtMatrix::look_at(PbrtText& text) {
  const Vector64 eye = vector(text), target = vector(text), up = vector(text);
  const Vector64 z = normalized(target - eye, {0, 0, 0});
  const Vector64 x = normalized(cross(up, z), {0, 0, 0});
  if (length(z) == 0 || length(x) == 0) text.fail("looks at its own place, or along its up vector", kCorrect);
  const Vector64 rows[3] = {x, cross(z, x), z};
  Affine to_camera;
  for (int row = 0; row < 3; ++row) {
    to_camera.m[row][0] = rows[row].x;
    to_camera.m[row][1] = rows[row].y;
    to_camera.m[row][2] = rows[row].z;
    to_camera.m[row][3] = -dot(rows[row], eye);
  }
  move(to_camera);
}

void PbrtMatrix::coordinate_system(PbrtText& text) {
  const std::string name(text.quoted("a name"));
  const auto found = systems_.find(name);
  if (found == systems_.end()) text.fail(fmt::format("there is no coordinate system '{}'", name), kCorrect);
  set(found->second);
}

void PbrtMatrix::active_transform(PbrtText& text) {
  const std::string_view which = text.statement();
  if (which != "All" && which != "StartTime" && which != "EndTime")
    text.fail("is none of All, StartTime, EndTime", kCorrect);
  at_start_ = which != "EndTime";
  if (!at_start_) draft_.warn("pbrt: transforms of the end of a motion are left out");
}

}  // namespace ctu::scene
