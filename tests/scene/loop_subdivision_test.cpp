// Loop subdivision against closed forms.
#include "model/scene/loop_subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "model/base/error.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

const Place kHere(std::string("test"));

void expect_near(const Vector64& is, const Vector64& should, double within = 1e-14) {
  EXPECT_NEAR(is.x, should.x, within);
  EXPECT_NEAR(is.y, should.y, within);
  EXPECT_NEAR(is.z, should.z, within);
}

ControlMesh tetrahedron() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

ControlMesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// A triangular lattice of the plane in `size` rows; its vertices are (i + j/2, j sqrt(3)/2), here sheared to (i, j).
ControlMesh lattice(int size) {
  ControlMesh mesh;
  for (int j = 0; j <= size; ++j)
    for (int i = 0; i <= size; ++i) mesh.vertices.push_back({double(i), double(j), 0});
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (size + 1) + i); };
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

std::size_t edges(const ControlMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> all;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) all.insert(std::minmax(t[i], t[(i + 1) % 3]));
  return all.size();
}

TEST(LoopSubdivision, every_triangle_becomes_four_and_the_kind_of_surface_stays) {
  for (const ControlMesh& mesh : {tetrahedron(), octahedron(), lattice(4)}) {
    const ControlMesh finer = subdivide_loop(mesh, kHere);
    EXPECT_EQ(finer.triangles.size(), 4 * mesh.triangles.size());
    EXPECT_EQ(finer.vertices.size(), mesh.vertices.size() + edges(mesh));
    const auto euler = [](const ControlMesh& m) {
      return static_cast<long>(m.vertices.size()) - static_cast<long>(edges(m)) + static_cast<long>(m.triangles.size());
    };
    EXPECT_EQ(euler(finer), euler(mesh));
  }
}

TEST(LoopSubdivision, one_level_of_a_tetrahedron_has_the_weights_of_valence_3) {
  // 1 - 3 * 3/16 of a corner and 3/16 of the others, which add up to minus the corner: 7/16 - 3/16.
  const ControlMesh finer = subdivide_loop(tetrahedron(), kHere);
  for (std::size_t v = 0; v < 4; ++v) expect_near(finer.vertices[v], tetrahedron().vertices[v] * 0.25);
  // 3/8 of the ends and 1/8 of the other two, which add up to minus the ends.
  expect_near(finer.vertices[4], (Vector64{1, 1, 1} + Vector64{1, -1, -1}) * 0.25);
}

TEST(LoopSubdivision, one_level_of_an_octahedron_has_the_weights_of_valence_4) {
  // The four neighbours add up to nothing: 1 - 4 * 3/32 is left.
  const ControlMesh finer = subdivide_loop(octahedron(), kHere);
  for (std::size_t v = 0; v < 6; ++v) expect_near(finer.vertices[v], octahedron().vertices[v] * 0.625);
  expect_near(finer.vertices[6], {0.375, 0.375, 0});  // edge 0 2: the corners across, 4 and 5, add up to nothing
}

TEST(LoopSubdivision, a_regular_vertex_has_the_box_splines_weights) {
  ControlMesh mesh = lattice(4);
  mesh.vertices[2 * 5 + 2].z = 1;  // the middle one, all six neighbours inside
  const ControlMesh finer = subdivide_loop(mesh, kHere);
  EXPECT_DOUBLE_EQ(finer.vertices[2 * 5 + 2].z, 10.0 / 16);
  EXPECT_DOUBLE_EQ(finer.vertices[2 * 5 + 3].z, 1.0 / 16);
  const ControlMesh limit = on_limit_surface(mesh, kHere);
  EXPECT_DOUBLE_EQ(limit.vertices[2 * 5 + 2].z, 0.5);
  EXPECT_DOUBLE_EQ(limit.vertices[2 * 5 + 3].z, 1.0 / 12);
  // An affine function is reproduced inside.
  expect_near(finer.vertices[2 * 5 + 2] - Vector64{0, 0, 10.0 / 16}, {2, 2, 0});
}

TEST(LoopSubdivision, a_limit_point_stays_where_it_is_when_the_mesh_gets_finer) {
  for (const ControlMesh& mesh : {tetrahedron(), octahedron(), lattice(3)}) {
    const ControlMesh limit = on_limit_surface(mesh, kHere);
    ControlMesh finer = mesh;
    for (int level = 0; level < 3; ++level) {
      finer = subdivide_loop(finer, kHere);
      const ControlMesh again = on_limit_surface(finer, kHere);
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v) expect_near(again.vertices[v], limit.vertices[v]);
    }
  }
}

TEST(LoopSubdivision, weights_add_up_to_one) {
  for (ControlMesh mesh : {tetrahedron(), octahedron(), lattice(3)}) {
    const Vector64 far{100, -200, 300};
    const ControlMesh here = on_limit_surface(subdivide_loop(mesh, kHere), kHere);
    for (Vector64& v : mesh.vertices) v = v + far;
    const ControlMesh there = on_limit_surface(subdivide_loop(mesh, kHere), kHere);
    for (std::size_t v = 0; v < here.vertices.size(); ++v)
      expect_near(there.vertices[v] - far, here.vertices[v], 1e-11);
  }
}

TEST(LoopSubdivision, a_boundary_is_the_cubic_b_spline_of_its_own_points) {
  // The boundary of a lattice depends on nothing inside: lift all that is not on its lower side.
  ControlMesh flat = lattice(4), lifted = flat;
  for (std::size_t v = 5; v < lifted.vertices.size(); ++v) lifted.vertices[v].z = 7;
  flat.vertices[2].y = lifted.vertices[2].y = 1;
  const ControlMesh finer = subdivide_loop(flat, kHere), other = subdivide_loop(lifted, kHere);
  for (std::size_t v = 1; v < 4; ++v) expect_near(other.vertices[v], finer.vertices[v]);
  EXPECT_DOUBLE_EQ(finer.vertices[2].y, 6.0 / 8);
  EXPECT_DOUBLE_EQ(finer.vertices[1].y, 1.0 / 8);
  EXPECT_DOUBLE_EQ(on_limit_surface(flat, kHere).vertices[2].y, 4.0 / 6);
}

TEST(LoopSubdivision, what_is_no_surface_is_refused) {
  EXPECT_THROW(subdivide_loop({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1}}}, kHere), Error);
  EXPECT_THROW(
      subdivide_loop({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}},
                     kHere),
      Error);
}

using PbrtLoopTest = SceneFiles;

constexpr const char* kTetrahedron =
    "\"point P\" [1 1 1  1 -1 -1  -1 1 -1  -1 -1 1] \"integer indices\" [0 1 2  0 2 3  0 3 1  1 3 2]\n";

TEST_F(PbrtLoopTest, its_levels_are_made_and_its_vertices_brought_to_the_limit) {
  const Scene scene = load(write("a.pbrt", std::string("WorldBegin\nTranslate 0 0 10\nShape \"loopsubdiv\" "
                                                       "\"integer nlevels\" [2] ") +
                                               kTetrahedron));
  EXPECT_EQ(scene.mesh.triangles.size(), 64u);
  EXPECT_EQ(scene.mesh.vertices.size(), 34u);  // 4 + 6 + 24
  // The limit of a tetrahedron's corner: 1 - 3 g - g of it, g = 1/(3 + 2).
  EXPECT_FLOAT_EQ(scene.mesh.vertices[0].x, 0.2f);
  EXPECT_FLOAT_EQ(scene.mesh.vertices[0].z, 10.2f);
  EXPECT_EQ(
      load(write("b.pbrt", std::string("WorldBegin\nShape \"loopsubdiv\" ") + kTetrahedron)).mesh.triangles.size(),
      256u);  // pbrt's three levels
}

TEST_F(PbrtLoopTest, wrong_ones_are_errors_with_their_line) {
  const auto shape = [&](const std::string& rest) {
    return write("a.pbrt", "WorldBegin\nShape \"loopsubdiv\"\n" + rest + "\n");
  };
  expect_error(shape("\"integer nlevels\" [1]"), "a.pbrt:2", "without points");
  expect_error(shape(std::string("\"integer nlevels\" [-1] ") + kTetrahedron), "a.pbrt:3", "levels");
  expect_error(shape(std::string("\"integer nlevels\" [1.5] ") + kTetrahedron), "a.pbrt:3", "levels");
  expect_error(shape(std::string("\"integer nlevels\" [7] ") + kTetrahedron), "a.pbrt:3", "levels");
  std::string many;
  for (int i = 0; i < 32768; ++i) many += "0 1 2 ";
  expect_error(shape("\"integer nlevels\" [6] \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [" + many + "]"),
               "a.pbrt:2", "more than");
  expect_error(shape("\"integer nlevels\" [1] \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]"), "a.pbrt:3",
               "names none");
  expect_error(shape("\"integer nlevels\" [1] \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 1]"), "a.pbrt:2",
               "twice");
}

}  // namespace
}  // namespace ctu::scene::test
