// Small scene files written by the tests themselves.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "model/scene/load.h"

namespace ctu::scene::test {

/// A test with a folder of its own, removed at the end.
class SceneFiles : public ::testing::Test {
 protected:
  SceneFiles();
  ~SceneFiles() override;

  /// Writes a file (and the folders above it) and returns its path.
  std::string write(const std::string& name, std::string_view bytes) const;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

/// Bytes of binary formats, little-endian unless said otherwise.
class Bytes {
 public:
  explicit Bytes(bool big_endian = false) : big_endian_(big_endian) {}
  template <class Number>
  requires std::is_arithmetic_v<Number> Bytes& add(Number value) { return raw(&value, sizeof(value)); }
  Bytes& add(std::string_view text) {
    text_ += text;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  Bytes& raw(const void* value, std::size_t bytes);
  std::string text_;
  bool big_endian_;
};

std::string compressed(std::string_view bytes);

/// Loads and expects an Error whose place contains `where` and whose problem contains `problem`; the remedy is not
/// empty.
void expect_error(const std::string& name, const std::string& where, const std::string& problem);

/// The corners of a triangle of a mesh.
std::array<Vec3, 3> corners(const Mesh& mesh, std::size_t triangle);

std::string glb(std::string json, std::string binary);
/// A .hair with 16-bit segment counts, points and, if given, one thickness a point.
std::string hair_file(const std::vector<std::vector<Vec3>>& strands, float thickness, bool with_segments,
                      const std::vector<float>& thicknesses = {});
std::string tfx_file(const std::vector<std::vector<Vec3>>& strands);

}  // namespace ctu::scene::test
