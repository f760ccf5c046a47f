// Packet culling on cases small enough to work out by hand: the paper's examples, its special cases, and what sets the
// methods apart. Random packets are judged by tests/check/packet_campaign_test.cpp.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "model/cull/packet/method.h"

namespace {

using namespace ctu;
using namespace ctu::cull::packet;
using intersect::Ray;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Ray ray(const Vec3& origin, const Vec3& direction, float tmin = 0, float tmax = kInfinity) {
  return {origin, tmin, direction, tmax};
}

template <class Primitive>
Answer ask(Method method, const std::vector<Ray>& rays, const Primitive& primitive) {
  return Bounds(method, make_lines(rays, scale_of(method))).test(primitive);
}

/// From one eye at the origin through the corners and the middle of a window at x = 10.
std::vector<Ray> camera(float half_width) {
  const float w = half_width;
  return {ray({}, {10, -w, -w}), ray({}, {10, w, -w}), ray({}, {10, -w, w}), ray({}, {10, w, w}), ray({}, {10, 0, 0})};
}

// Fig. 3: O_x = [-3,-1], O_y = [1,2], V_x = [1,2], V_y = [1,3] against [2,3] x [-1,2]: T_x = [3/2,6], T_y = [-3,1].
TEST(PacketBounds, the_papers_walkthrough_is_rejected) {
  const std::vector<Ray> rays = {ray({-3, 1, 0}, {1, 1, 1}), ray({-1, 2, 0}, {2, 3, 1})};
  EXPECT_EQ(ask(Method::Interval, rays, Box{{2, -1, -100}, {3, 2, 100}}), Answer::AllMiss);
}

TEST(PacketBounds, every_method_rejects_a_box_beside_a_camera_packet_and_none_one_inside) {
  for (const Method method : kMethods) {
    SCOPED_TRACE(std::string(to_string(method)));
    EXPECT_EQ(ask(method, camera(1), Box{{10, 2, -1}, {11, 3, 1}}), Answer::AllMiss);
    EXPECT_EQ(ask(method, camera(1), Box{{10, -0.5f, -0.5f}, {11, 0.5f, 0.5f}}), Answer::Undecided);
    EXPECT_EQ(ask(method, camera(1), Box{{-3, -1, -1}, {-2, 1, 1}}), Answer::AllMiss) << "behind";
  }
}

TEST(PacketBounds, all_rays_of_a_narrow_packet_hit_a_wide_box_and_triangle) {
  for (const Method method : {Method::Interval, Method::AxisInterval, Method::CornerRays, Method::Affine}) {
    SCOPED_TRACE(std::string(to_string(method)));
    EXPECT_EQ(ask(method, camera(1), Box{{10, -2, -2}, {11, 2, 2}}), Answer::AllHit);
    EXPECT_EQ(ask(method, camera(1), Triangle{{{10, -9, -9}, {10, 9, -9}, {10, 0, 20}}}), Answer::AllHit);
    EXPECT_EQ(ask(method, camera(1), Triangle{{{10, 0, 20}, {10, 9, -9}, {10, -9, -9}}}), Answer::AllHit)
        << "from its back";
  }
}

TEST(PacketBounds, all_hit_needs_every_rays_own_range) {
  std::vector<Ray> rays = camera(1);
  rays[2].tmax = 0.5f;  // ends at x = 5
  for (const Method method : kMethods) {
    SCOPED_TRACE(std::string(to_string(method)));
    EXPECT_EQ(ask(method, rays, Box{{10, -2, -2}, {11, 2, 2}}), Answer::Undecided);
    EXPECT_EQ(ask(method, rays, Triangle{{{10, -9, -9}, {10, 9, -9}, {10, 0, 20}}}), Answer::Undecided);
  }
}

TEST(PacketBounds, rays_that_may_not_reach_any_more_miss) {
  for (const Method method : kMethods) {
    SCOPED_TRACE(std::string(to_string(method)));
    const std::vector<Ray> rays = camera(1);
    const Lines lines = make_lines(rays, scale_of(method));
    Reach reach = Reach::none();
    for (std::size_t i = 0; i < rays.size(); ++i) lines.extend(reach, i, 0.75f);  // to x = 7.5
    const Box box{{10, -2, -2}, {11, 2, 2}};
    EXPECT_EQ(Bounds(method, lines).test(box, reach), Answer::AllMiss);
  }
}

// Section 4.1.3 and Fig. 4: slopes change their sign with dk, normals must not.
TEST(PacketBounds, a_packet_that_goes_backward_is_bounded_as_its_mirror_image) {
  for (const Method method : kMethods) {
    SCOPED_TRACE(std::string(to_string(method)));
    for (const float beside : {-1.5f, -1.25f, -0.5f, 0.5f, 1.25f, 1.5f})
      for (const float slope : {-0.2f, 0.1f}) {
        std::vector<Ray> forward, backward;
        for (const float spread : {0.0f, 0.05f, 0.1f}) {
          forward.push_back(ray({0, spread, 0}, {1, slope + spread, spread}));
          backward.push_back(ray({0, spread, 0}, {-1, slope + spread, spread}));
        }
        const float y = 4 * slope + beside;
        EXPECT_EQ(ask(method, forward, Box{{4, y, -1}, {4.5f, y + 0.1f, 1}}),
                  ask(method, backward, Box{{-4.5f, y, -1}, {-4, y + 0.1f, 1}}))
            << beside << " " << slope;
      }
  }
}

// Fig. 6: the triangle's plane lies behind some corner rays; rays between them do not pass between their points.
TEST(PacketBounds, corner_rays_conclude_nothing_where_they_cross_the_plane_in_different_senses) {
  const std::vector<Ray> rays = {ray({0, 0, 0}, {1, -1, 0}), ray({0, 0, 0}, {1, 1, 0}), ray({0, 0, 0}, {1, 0.9f, 0})};
  // In the plane x = 4 y - 1: the line of the first ray meets it at x = -1/5, the others' at x = 1/3 and 0.38.
  const Triangle met{{{0.2f, 0.3f, -1}, {1.4f, 0.6f, -1}, {0.5f, 0.375f, 2}}};
  EXPECT_NE(ask(Method::CornerRays, rays, met), Answer::AllMiss);
}

TEST(PacketBounds, all_rays_that_go_away_from_a_triangles_plane_miss_it) {
  const std::vector<Ray> rays = {ray({0, 0, 0}, {1, 0.25f, 0}), ray({0, 0, 1}, {1, 0.5f, 0.1f})};
  const Triangle under{{{-5, -0.5f, -5}, {9, -0.25f, -5}, {0, -0.375f, 9}}};
  EXPECT_EQ(ask(Method::CornerRays, rays, under), Answer::AllMiss);
}

// Section 7: a triangle fills half of its box at most, so corner rays reject what no plane of the packet can.
TEST(PacketBounds, corner_rays_reject_a_triangle_whose_box_the_packet_meets) {
  const Triangle triangle{{{10, -5, -5}, {10, 5, -5}, {10, -5, 5}}};  // the packet passes at y = z = 3
  std::vector<Ray> rays;
  for (const float y : {2.5f, 3.5f})
    for (const float z : {2.5f, 3.5f}) rays.push_back(ray({}, {10, y, z}));
  EXPECT_EQ(ask(Method::Planes, rays, triangle), Answer::Undecided);
  EXPECT_EQ(ask(Method::CornerRays, rays, triangle), Answer::AllMiss);
  EXPECT_EQ(ask(Method::Affine, rays, triangle), Answer::AllMiss);
}

// Shadow rays: the volume narrows towards the light, which planes that only spread cannot say.
TEST(PacketBounds, affine_forms_follow_rays_that_meet_in_a_point) {
  const Vec3 light{8, 0, 0};
  std::vector<Ray> rays;
  for (const float y : {-2.0f, -0.5f, 1.0f, 2.0f})
    for (const float z : {-2.0f, 2.0f}) rays.push_back(ray({0, y, z}, {light.x, -y, -z}, 0, 1));
  const Box beside_the_light{{7.5f, 0.5f, -0.25f}, {7.75f, 1, 0.25f}};
  EXPECT_EQ(ask(Method::Affine, rays, beside_the_light), Answer::AllMiss);
  EXPECT_EQ(ask(Method::Planes, rays, beside_the_light), Answer::Undecided);
  EXPECT_EQ(ask(Method::AxisInterval, rays, beside_the_light), Answer::Undecided);
}

TEST(PacketBounds, packets_of_opposite_signs_have_no_major_axis_and_are_culled_all_the_same) {
  const std::vector<Ray> rays = {ray({0, 0, 0}, {1, 1, 1}), ray({0, 0, 0}, {-1, -1, -1}), ray({1, 0, 0}, {1, -1, 0})};
  EXPECT_EQ(make_lines(rays, Scale::MajorAxis).axis, -1);
  std::vector<Ray> short_rays = rays;
  for (Ray& r : short_rays) r.tmax = 2;
  const Box box{{4, 4, 4}, {5, 5, 5}};
  EXPECT_EQ(ask(Method::Interval, short_rays, box), Answer::AllMiss);
  EXPECT_EQ(ask(Method::Planes, short_rays, box), Answer::AllMiss);
  EXPECT_EQ(ask(Method::CornerRays, short_rays, box), Answer::Undecided);
}

TEST(PacketBounds, a_moving_triangle_is_culled_by_its_six_vertices_only) {
  const Triangle left{{{10, 3, -1}, {10, 4, 1}, {11, 3, 0}}}, right{{{10, -3, -1}, {10, -4, 1}, {11, -3, 0}}};
  const Triangle further{{{10, 5, -1}, {10, 6, 1}, {11, 5, 0}}};
  EXPECT_EQ(ask(Method::Planes, camera(1), MovingTriangle{left, further}), Answer::AllMiss);
  EXPECT_EQ(ask(Method::Planes, camera(1), MovingTriangle{left, right}), Answer::Undecided) << "it crosses the packet";
  EXPECT_EQ(ask(Method::Planes, camera(1), left), Answer::AllMiss);
  EXPECT_EQ(ask(Method::Planes, camera(1), right), Answer::AllMiss);
}

TEST(PacketBounds, spheres_beside_and_behind_a_packet_are_missed_and_large_ones_met) {
  for (const Method method : {Method::Interval, Method::AxisInterval, Method::Planes, Method::Affine}) {
    SCOPED_TRACE(std::string(to_string(method)));
    EXPECT_EQ(ask(method, camera(0.1f), Sphere{{10, 3, 0}, 1}), Answer::AllMiss);
    EXPECT_EQ(ask(method, camera(0.1f), Sphere{{-5, 0, 0}, 1}), Answer::AllMiss);
    EXPECT_NE(ask(method, camera(0.1f), Sphere{{10, 1, 0}, 1}), Answer::AllMiss) << "one ray touches it, nearly";
    if (method != Method::Planes) {
      EXPECT_EQ(ask(method, camera(0.1f), Sphere{{10, 0, 0}, 3}), Answer::AllHit);
      EXPECT_EQ(ask(method, camera(0.1f), Sphere{{10, 0, 0}, -3}), Answer::AllHit);
    }
  }
}

TEST(PacketBounds, a_major_axis_is_the_one_that_all_directions_keep_to_best) {
  EXPECT_EQ(make_lines(std::vector{ray({}, {1, 0.001f, 5}), ray({}, {2, 0.001f, -5})}, Scale::MajorAxis).axis, 0);
  const Lines backward = make_lines(std::vector{ray({}, {0.1f, -1, 0}), ray({}, {0.1f, -1, 0.5f})}, Scale::MajorAxis);
  EXPECT_EQ(backward.axis, 1);
  EXPECT_TRUE(backward.backward);
  EXPECT_TRUE(backward.shared_origin);
}

TEST(PacketBounds, a_packet_surrounds_boxes_between_its_planes) {
  const BoundingPlanes planes(make_lines(camera(1), Scale::MajorAxis));
  EXPECT_TRUE(planes.surrounds({{10, -0.5f, -0.5f}, {11, 0.5f, 0.5f}}));
  EXPECT_FALSE(planes.surrounds({{10, -0.5f, -0.5f}, {11, 1.5f, 0.5f}}));
  EXPECT_FALSE(planes.surrounds({{-11, -0.5f, -0.5f}, {-10, 0.5f, 0.5f}}));
}

}  // namespace
