#include "model/scene/affine.h"

#include <cmath>

#include "model/scene/turn.h"

namespace ctu::scene {

Vector64 Affine::point(const Vector64& p) const {
  return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
          m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
          m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
}

Vector64 Affine::direction(const Vector64& d) const {
  return {m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z, m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z,
          m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z};
}

Affine operator*(const Affine& a, const Affine& b) {
  Affine product;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      product.m[row][column] = a.m[row][0] * b.m[0][column] + a.m[row][1] * b.m[1][column] +
                               a.m[row][2] * b.m[2][column] + (column == 3 ? a.m[row][3] : 0.0);
  return product;
}

std::optional<Affine> inverse(const Affine& a) {
  const Vector64 x{a.m[0][0], a.m[1][0], a.m[2][0]}, y{a.m[0][1], a.m[1][1], a.m[2][1]},
      z{a.m[0][2], a.m[1][2], a.m[2][2]}, t{a.m[0][3], a.m[1][3], a.m[2][3]};
  const double determinant = dot(x, cross(y, z));
  if (determinant == 0 || !std::isfinite(determinant)) return std::nullopt;
  const Vector64 rows[3] = {cross(y, z) * (1 / determinant), cross(z, x) * (1 / determinant),
                            cross(x, y) * (1 / determinant)};
  Affine result;
  for (int row = 0; row < 3; ++row) {
    result.m[row][0] = rows[row].x;
    result.m[row][1] = rows[row].y;
    result.m[row][2] = rows[row].z;
    result.m[row][3] = -dot(rows[row], t);
  }
  return result;
}

Affine translation(const Vector64& t) {
  Affine result;
  result.m[0][3] = t.x;
  result.m[1][3] = t.y;
  result.m[2][3] = t.z;
  return result;
}

Affine scaling(const Vector64& s) {
  Affine result;
  result.m[0][0] = s.x;
  result.m[1][1] = s.y;
  result.m[2][2] = s.z;
  return result;
}

std::optional<Affine> rotation(double degrees, const Vector64& axis) {
  if (length(axis) == 0 || !std::isfinite(degrees)) return std::nullopt;
  const Vector64 a = normalized(axis, {0, 0, 1});
  const auto [c, s] = turn(degrees / 360);
  Affine result;
  const double rows[3][3] = {
      {a.x * a.x + (1 - a.x * a.x) * c, a.x * a.y * (1 - c) - a.z * s, a.x * a.z * (1 - c) + a.y * s},
      {a.x * a.y * (1 - c) + a.z * s, a.y * a.y + (1 - a.y * a.y) * c, a.y * a.z * (1 - c) - a.x * s},
      {a.x * a.z * (1 - c) - a.y * s, a.y * a.z * (1 - c) + a.x * s, a.z * a.z + (1 - a.z * a.z) * c}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result.m[row][column] = rows[row][column];
  return result;
}

std::optional<Affine> rotation(const std::array<double, 4>& quaternion) {
  const auto [x, y, z, w] = quaternion;
  const double squared = x * x + y * y + z * z + w * w;
  if (squared == 0 || !std::isfinite(squared)) return std::nullopt;
  const double s = 2 / squared;
  Affine result;
  const double rows[3][3] = {{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                             {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                             {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result.m[row][column] = rows[row][column];
  return result;
}

std::optional<Affine> from_columns(const std::array<double, 16>& numbers) {
  if (numbers[3] != 0 || numbers[7] != 0 || numbers[11] != 0 || numbers[15] != 1) return std::nullopt;
  Affine result;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      result.m[row][column] = numbers[static_cast<std::size_t>(4 * column + row)];
  return result;
}

}  // namespace ctu::scene
