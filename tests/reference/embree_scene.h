// Embree as a second opinion and as the speed to compare with: one triangle mesh, one thread.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>
#include <limits>
#include <memory>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"

namespace ctu::test {

class EmbreeScene {
 public:
  /// `mesh` must outlive this. `robust` asks for RTC_SCENE_FLAG_ROBUST. Not usable before commit().
  EmbreeScene(const scene::Mesh& mesh, bool robust)
      : device_(rtcNewDevice("threads=1"), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
    rtcSetSceneFlags(scene_.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads vertices 16 bytes at a time: one more behind the last.
    vertices_ = std::make_unique<Vec3[]>(mesh.vertices.size() + 1);
    std::copy(mesh.vertices.begin(), mesh.vertices.end(), vertices_.get());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices_.get(), 0, sizeof(Vec3),
                               mesh.vertices.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               3 * sizeof(std::uint32_t), mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }

  /// Builds the tree.
  void commit() { rtcCommitScene(scene_.get()); }

  intersect::Hit closest(const intersect::Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.tnear = ray.tmin;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.time = 0;
    query.ray.tfar = ray.tmax;
    query.ray.mask = 0xFFFFFFFFu;
    query.ray.id = 0;
    query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {ray.tmax, 0, 0, intersect::kNoPrimitive};
    return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
  }

 private:
  std::unique_ptr<Vec3[]> vertices_;
  std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device_;
  std::unique_ptr<RTCSceneTy, void (*)(RTCScene)> scene_;
};

}  // namespace ctu::test
