#include <sys/stat.h>

#include <cmath>

#include "model/base/error.h"
#include "model/scene/vector64.h"
#include "tests/scene/scene_files.h"

namespace ctu::scene::test {
namespace {

using LoadTest = SceneFiles;

constexpr const char* kNear = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kFar = "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n";

TEST_F(LoadTest, a_compressed_file_is_read_as_what_it_holds) {
  const Scene plain = load(write("a.obj", kNear));
  const Scene packed = load(write("b.obj.zst", compressed(kNear)));
  EXPECT_EQ(content_hash(plain.mesh), content_hash(packed.mesh));
  EXPECT_EQ(packed.name, "b");
  const Scene two_frames =
      load(write("c.obj.zst", compressed("v 0 0 0\nv 1 0 0\n") + compressed("v 0 1 0\nf 1 2 3\n")));
  EXPECT_EQ(content_hash(plain.mesh), content_hash(two_frames.mesh));
}

TEST_F(LoadTest, damaged_compression_is_an_error) {
  const std::string packed = compressed(std::string(kNear) + std::string(5000, '#'));
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes)
    EXPECT_THROW(load(write("cut.obj.zst", packed.substr(0, bytes))), Error) << bytes;
  expect_error(write("no.obj.zst", kNear), "no.obj.zst: byte 0", "damaged as zstd");
}

TEST_F(LoadTest, several_files_make_one_scene_in_their_order) {
  const Scene scene = load(write("near.obj", kNear) + "," + write("far.obj", kFar));
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(corners(scene.mesh, 1)[0], (Vec3{0, 0, 9}));
  EXPECT_EQ(scene.name, "near+far");
}

TEST_F(LoadTest, a_file_with_a_comma_in_its_name_is_one_file) {
  EXPECT_EQ(load(write("a,b.obj", kNear)).mesh.triangles.size(), 1u);
}

TEST_F(LoadTest, a_list_names_files_from_its_own_folder_and_a_camera) {
  const char* shape = "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0]\n";
  write("parts/one.pbrt", std::string("Include \"parts/move.pbrt\"\n") + shape);
  write("parts/move.pbrt", "Translate 0 0 1\n");
  write("far.obj", kFar);
  write("view.pbrt", "LookAt 1 2 3 4 5 6 0 0 1\nCamera \"perspective\"\nWorldBegin\nInclude \"not-there.pbrt\"\n");
  const Scene scene = load(write("all.list", "# parts\ncamera view.pbrt\nparts/one.pbrt  \n\nfar.obj\n"));
  ASSERT_EQ(scene.mesh.triangles.size(), 2u);
  EXPECT_EQ(corners(scene.mesh, 0)[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.report.format, "pbrt+obj");
  EXPECT_EQ(scene.name, "all");
}

TEST_F(LoadTest, files_that_a_scene_names_can_be_left_out_by_name) {
  write("parts/leaf_1.obj", kNear);
  write("parts/leaf_2.obj", kNear);
  write("parts/stem.obj", kFar);
  const std::string list = write("tree.list", "parts/leaf_1.obj\nparts/leaf_2.obj\nparts/stem.obj\n");
  LoadOptions options;
  options.without = {"leaf_*"};
  const Scene stem = load(list, options);
  ASSERT_EQ(stem.mesh.triangles.size(), 1u);
  EXPECT_EQ(corners(stem.mesh, 0)[0], (Vec3{0, 0, 9}));
  ASSERT_EQ(stem.report.warnings.size(), 1u);
  EXPECT_EQ(stem.report.warnings[0], "'leaf_*' was left out (2 times)");
  options.without = {"leaf_1.obj", "stem.obj"};
  EXPECT_EQ(load(list, options).mesh.triangles.size(), 1u);
}

TEST_F(LoadTest, leaving_out_what_is_not_there_or_everything_is_an_error) {
  write("one.obj", kNear);
  const std::string list = write("all.list", "one.obj\n");
  const auto expect_refused = [&](const std::string& pattern, const std::string& problem) {
    LoadOptions options;
    options.without = {pattern};
    try {
      load(list, options);
      ADD_FAILURE() << pattern << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(problem), std::string::npos) << error.what();
    }
  };
  expect_refused("two.obj", "'two.obj'");
  expect_refused("one", "'one'");
  expect_refused("*", "no triangles");
}

TEST_F(LoadTest, a_wrong_list_is_an_error_with_its_line) {
  expect_error(write("a.list", "\nabsent.obj\n"), "a.list:2", "names 'absent.obj'");
  write("b.obj", kNear);
  expect_error(write("b.list", "camera b.obj\n"), "b.list:1", "camera");
  expect_error(write("c.list", "c.list\n"), "c.list", "no scene format");
  expect_error(write("d.list", "# nothing\n"), "d.list", "no triangles");
}

TEST_F(LoadTest, what_is_no_scene_is_an_error) {
  expect_error(path("absent.ply"), "absent.ply", "cannot be opened");
  expect_error(write("a.stl", "solid"), "a.stl", "'.stl' is no scene format");
  expect_error(write("folder.obj/x", ""), "x", "no scene format");
  expect_error(path("folder.obj"), "folder.obj", "is a folder");
  expect_error("", "", "no scene format");
}

TEST_F(LoadTest, a_scene_called_scene_is_named_after_its_folder) {
  EXPECT_EQ(load(write("kitchen/scene.obj", kNear)).name, "kitchen");
}

TEST_F(LoadTest, bounds_leave_out_vertices_that_no_triangle_uses) {
  const Scene scene = load(write("a.obj", std::string("v 100 100 100\n") + "v 0 0 0\nv 1 0 0\nv 0 1 2\nf 2 3 4\n"));
  EXPECT_EQ(scene.lower, (Vec3{0, 0, 0}));
  EXPECT_EQ(scene.upper, (Vec3{1, 1, 2}));
}

TEST_F(LoadTest, the_default_camera_sees_every_corner_of_the_box) {
  for (const std::string& name :
       {write("a.obj", "v -3 0 100\nv 9 1 100\nv 0 70 120\nf 1 2 3\n"), std::string("gen:foliage"),
        write("flat.obj", "v 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3\n")}) {
    SCOPED_TRACE(name);
    const Scene scene = load(name);
    const Camera& camera = scene.camera;
    EXPECT_FALSE(camera.from_file);
    const Vector64 toward = normalized(Vector64(camera.target) - Vector64(camera.eye), {0, 0, 0});
    ASSERT_GT(length(toward), 0.9);
    const Vector64 right = normalized(cross(toward, Vector64(camera.up)), {0, 0, 0}), up = cross(right, toward);
    for (int corner = 0; corner < 8; ++corner) {
      const Vector64 p{corner & 1 ? scene.upper.x : scene.lower.x, corner & 2 ? scene.upper.y : scene.lower.y,
                       corner & 4 ? scene.upper.z : scene.lower.z};
      const Vector64 seen = p - Vector64(camera.eye);
      const double reach = std::tan(camera.vertical_fov_degrees / 2 * 3.14159265358979 / 180) * dot(seen, toward);
      EXPECT_LE(std::fabs(dot(seen, right)), reach);
      EXPECT_LE(std::fabs(dot(seen, up)), reach);
    }
  }
}

TEST_F(LoadTest, the_content_hash_tells_vertices_and_triangles_apart) {
  const Mesh a{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Mesh moved = a, turned = a, negative_zero = a;
  moved.vertices[1].x = std::nextafter(1.0f, 2.0f);
  turned.triangles[0] = {1, 2, 0};
  negative_zero.vertices[0].x = -0.0f;
  EXPECT_EQ(content_hash(a), content_hash(Mesh(a)));
  EXPECT_NE(content_hash(a), content_hash(moved));
  EXPECT_NE(content_hash(a), content_hash(turned));
  EXPECT_NE(content_hash(a), content_hash(negative_zero));
}

TEST_F(LoadTest, what_expands_far_beyond_any_scene_is_refused) {
  const std::string packed = compressed(std::string(40'000'000, '\n'));
  ASSERT_LT(packed.size(), 10'000u);
  expect_error(write("bomb.obj.zst", packed), "bomb.obj.zst", "expand to more than 16777216 bytes");
}

TEST_F(LoadTest, a_pipe_is_refused_without_waiting_for_it) {
  ASSERT_EQ(mkfifo(path("pipe.obj").c_str(), 0600), 0);
  expect_error(path("pipe.obj"), "pipe.obj", "is a pipe or a device");
  ASSERT_EQ(mkfifo(path("MISSING.txt").c_str(), 0600), 0);
  expect_error(write("a.list", "pipe.obj\n"), "a.list:1", "names 'pipe.obj'");
}

TEST_F(LoadTest, a_pattern_that_could_take_for_ever_is_refused) {
  LoadOptions options;
  options.without = {"*a*a*a*a*a*a*a*b"};
  try {
    load(write("a.list", std::string(250, 'a') + ".obj\n"), options);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("has more than 3 stars"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ctu::scene::test
