#include "tests/scene/scene_files.h"

#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>

#include "model/base/error.h"

namespace ctu::scene::test {

SceneFiles::SceneFiles() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ = std::filesystem::temp_directory_path() /
            ("ctu_scene_" + std::to_string(getpid()) + "_" + info->test_suite_name() + "_" + info->name());
  std::filesystem::create_directories(folder_);
}

SceneFiles::~SceneFiles() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string SceneFiles::write(const std::string& name, std::string_view bytes) const {
  const auto file = folder_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::remove(file);  // some file systems flush a file that is cut to nothing and written again: slow
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file.string();
}

Bytes& Bytes::raw(const void* value, std::size_t bytes) {
  std::string piece(static_cast<const char*>(value), bytes);
  if (big_endian_) std::reverse(piece.begin(), piece.end());
  text_ += piece;
  return *this;
}

std::string compressed(std::string_view bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

void expect_error(const std::string& name, const std::string& where, const std::string& problem) {
  try {
    const Scene scene = load(name);
    ADD_FAILURE() << "loaded " << scene.mesh.triangles.size() << " triangles, expected an error: " << problem;
  } catch (const Error& error) {
    EXPECT_NE(error.where().find(where), std::string::npos) << "place: " << error.where() << "\nexpected: " << where;
    EXPECT_NE(error.problem().find(problem), std::string::npos)
        << "problem: " << error.problem() << "\nexpected: " << problem;
    EXPECT_FALSE(error.remedy().empty());
  }
}

std::array<Vec3, 3> corners(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles.at(triangle);
  return {mesh.vertices.at(a), mesh.vertices.at(b), mesh.vertices.at(c)};
}

std::string glb(std::string json, std::string binary) {
  while (json.size() % 4 != 0) json += ' ';
  while (binary.size() % 4 != 0) binary += '\0';
  const auto size = [](const std::string& s) { return static_cast<std::uint32_t>(s.size()); };
  Bytes bytes;
  bytes.add("glTF").add(std::uint32_t{2}).add(std::uint32_t{28} + size(json) + size(binary));
  bytes.add(size(json)).add("JSON").add(json);
  bytes.add(size(binary)).add(std::string_view("BIN\0", 4)).add(binary);
  return bytes.text();
}

std::string hair_file(const std::vector<std::vector<Vec3>>& strands, float thickness, bool with_segments,
                      const std::vector<float>& thicknesses) {
  std::uint32_t points = 0;
  for (const auto& strand : strands) points += static_cast<std::uint32_t>(strand.size());
  const std::uint32_t bits = (with_segments ? 1u : 0u) | 2u | (thicknesses.empty() ? 0u : 4u);
  Bytes bytes;
  bytes.add("HAIR").add(static_cast<std::uint32_t>(strands.size())).add(points).add(bits);
  bytes.add(strands.empty() ? 0u : static_cast<std::uint32_t>(strands[0].size() - 1)).add(thickness);
  bytes.add(0.0f).add(1.0f).add(1.0f).add(1.0f).add(std::string(88, '\0'));
  if (with_segments)
    for (const auto& strand : strands) bytes.add(static_cast<std::uint16_t>(strand.size() - 1));
  for (const auto& strand : strands)
    for (const Vec3& p : strand) bytes.add(p.x).add(p.y).add(p.z);
  for (const float t : thicknesses) bytes.add(t);
  return bytes.text();
}

std::string tfx_file(const std::vector<std::vector<Vec3>>& strands) {
  Bytes bytes;
  bytes.add(4.0f).add(static_cast<std::uint32_t>(strands.size()));
  bytes.add(static_cast<std::uint32_t>(strands.empty() ? 2 : strands[0].size())).add(std::uint32_t{160});
  bytes.add(std::string(144, '\0'));
  for (const auto& strand : strands)
    for (const Vec3& p : strand) bytes.add(p.x).add(p.y).add(p.z).add(1.0f);
  return bytes.text();
}

}  // namespace ctu::scene::test
