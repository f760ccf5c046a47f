// What packet culling finds on the rays of a scene, beside what there is to find: every question that packets come to
// is put to all methods and to every ray in exact arithmetic.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/packet/method.h"
#include "model/numeric/operation_meter.h"
#include "model/reference/packet_traversal.h"
#include "model/reference/step.h"
#include "model/scene/scene.h"
#include "sim/ray_sample.h"

namespace ctu::sim::paper {

inline constexpr std::size_t kPacketMethods = cull::packet::kMethods.size();

/// Questions about one kind of primitive.
struct PacketFindings {
  std::uint64_t questions = 0;
  std::uint64_t all_miss = 0;  ///< in exact arithmetic, of the rays that have come to the place
  std::array<std::uint64_t, kPacketMethods> found{};
  std::uint64_t found_by_some = 0;
  std::uint64_t lost = 0;  ///< answers of all-miss where some ray meets the primitive: a defect
  std::array<numeric::OperationCounts, kPacketMethods> operations{};

  PacketFindings& operator+=(const PacketFindings& other);
};

/// What the tests of a method leave of the work, and whether any hit changed.
struct PacketWork {
  reference::PacketCounts counts;
  std::uint64_t lost_hits = 0, near_misses = 0, ties = 0;

  PacketWork& operator+=(const PacketWork& other);
};

/// How intervals bloat (section 6), sums over packets: the paper's example of V.V for directions of length 1, and o x
/// d.
struct PacketBloat {
  std::uint64_t packets = 0;
  double interval_length = 0, affine_length = 0;  ///< the greatest V.V; exactly, each is 1
  std::uint64_t wide_packets = 0;                 ///< in which not all rays have the same o x d
  double interval_moment = 0, affine_moment = 0;  ///< width of o x d, relative to that of the rays' own

  PacketBloat& operator+=(const PacketBloat& other);
};

struct PacketResult {
  std::uint64_t rays = 0;
  reference::Counts single;  ///< each ray alone
  PacketFindings boxes, triangles, spheres;
  std::uint64_t parts = 0;  ///< packets and parts of packets that were asked
  std::array<numeric::OperationCounts, kPacketMethods> building{};
  std::array<PacketWork, kPacketMethods> work{};
  PacketBloat bloat;

  std::uint64_t wrong() const;
  PacketResult& operator+=(const PacketResult& other);
};

struct PacketMeasureOptions {
  reference::FormingOptions forming;
  int least_rays = 4;
  int threads = 1;
};

/// All methods on the rays of one sample. The same for any number of threads.
PacketResult measure_packets(const scene::Scene& scene, const accel::Bvh4& bvh, const RaySample& sample,
                             const PacketMeasureOptions& options);

/// Only what one method leaves of the work.
PacketWork measure_packet_work(const scene::Scene& scene, const accel::Bvh4& bvh, const RaySample& sample,
                               cull::packet::Method method, const PacketMeasureOptions& options);

}  // namespace ctu::sim::paper
