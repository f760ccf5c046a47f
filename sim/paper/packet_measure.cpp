#include "sim/paper/packet_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "model/base/parallel.h"
#include "model/numeric/affine.h"
#include "sim/exact_meeting.h"
#include "sim/hit_judge.h"

namespace ctu::sim::paper {
namespace {

using cull::packet::Answer;
using cull::packet::Bounds;
using cull::packet::Box;
using cull::packet::kMethods;
using cull::packet::Lines;
using cull::packet::Method;
using cull::packet::Reach;
using cull::packet::Scale;
using cull::packet::Sphere;
using cull::packet::Triangle;
using intersect::Hit;
using intersect::Ray;
using numeric::OperationMeter;
using reference::PacketPlace;

constexpr std::size_t kWindowsPerChunk = 8;

/// In exact arithmetic, within what each ray that is here may still reach.
template <class Primitive>
bool all_miss(const PacketPlace& place, const Primitive& primitive) {
  for (std::size_t i = 0; i < place.rays.size(); ++i) {
    Ray ray = place.rays[i];
    if (!(ray.tmin <= place.limits[i])) continue;
    ray.tmax = place.limits[i];
    oracle::RayOracle oracle(ray);
    if (meets(oracle, primitive)) return false;
  }
  return true;
}

/// Puts every question to all methods.
class AllMethods : public reference::PacketObserver {
 public:
  explicit AllMethods(PacketResult& result) : result_(result) {}

  void begin_packet() override { parts_.clear(); }
  void box(const PacketPlace& place, const Box& box) override { ask(place, box, result_.boxes); }
  void triangle(const PacketPlace& place, const Triangle& triangle) override {
    ask(place, triangle, result_.triangles);
  }
  void sphere(const PacketPlace& place, const Sphere& sphere) override { ask(place, sphere, result_.spheres); }

 private:
  /// A part of the packet in both scales, and every method's bounds of it.
  struct Part {
    std::array<Lines, 2> lines;
    std::vector<Bounds> bounds;
  };

  const Part& part_of(const PacketPlace& place) {
    const auto [at, made] = parts_.try_emplace(place.part);
    if (!made) return at->second;
    Part& part = at->second;
    ++result_.parts;
    std::array<numeric::OperationCounts, 2> scaling;
    for (const Scale scale : {Scale::AsGiven, Scale::MajorAxis}) {
      const auto s = static_cast<std::size_t>(scale);
      const OperationMeter meter(scaling[s]);
      part.lines[s] = make_lines(place.rays, scale);
    }
    for (const Method method : kMethods) {
      const auto scale = static_cast<std::size_t>(scale_of(method));
      numeric::OperationCounts& building = result_.building[static_cast<std::size_t>(method)];
      const OperationMeter meter(building);
      part.bounds.emplace_back(method, part.lines[scale]);
      building += scaling[scale];
    }
    return part;
  }

  std::array<Reach, 2> reach_of(const Part& part, const PacketPlace& place) const {
    std::array<Reach, 2> reach{Reach::none(), Reach::none()};
    for (std::size_t i = 0; i < place.rays.size(); ++i) {
      if (place.limits[i] == -std::numeric_limits<float>::infinity()) continue;
      for (std::size_t s = 0; s < reach.size(); ++s) part.lines[s].extend(reach[s], i, place.limits[i]);
    }
    return reach;
  }

  template <class Primitive>
  void ask(const PacketPlace& place, const Primitive& primitive, PacketFindings& findings) {
    const Part& part = part_of(place);
    const std::array<Reach, 2> reach = reach_of(part, place);
    const bool missed = all_miss(place, primitive);
    ++findings.questions;
    findings.all_miss += missed;
    bool some = false;
    for (std::size_t m = 0; m < kPacketMethods; ++m) {
      const OperationMeter meter(findings.operations[m]);
      const Reach& limit = reach[static_cast<std::size_t>(scale_of(kMethods[m]))];
      const bool found = part.bounds[m].test(primitive, limit) == Answer::AllMiss;
      findings.found[m] += found;
      findings.lost += found && !missed;
      some = some || found;
    }
    findings.found_by_some += some;
  }

  PacketResult& result_;
  std::map<std::uint32_t, Part> parts_;
};

/// Of directions divided by their lengths; rounding is of no interest here.
void add_length(std::span<const Ray> rays, PacketBloat& bloat) {
  numeric::IntervalVector hull = numeric::IntervalVector::nothing();
  for (const Ray& ray : rays) {
    double length = 0;
    for (int axis = 0; axis < 3; ++axis) length += static_cast<double>(ray.direction[axis]) * ray.direction[axis];
    for (int axis = 0; axis < 3; ++axis) {
      const auto component = static_cast<float>(ray.direction[axis] / std::sqrt(length));
      hull[axis] = unite(hull[axis], numeric::Interval::point(component));
    }
  }
  numeric::Affine<3> squared;
  for (int axis = 0; axis < 3; ++axis) {
    const numeric::Middle middle = numeric::middle_of(hull[axis]);
    auto form = numeric::Affine<3>::point(middle.centre);
    form.part[static_cast<std::size_t>(axis)] = middle.radius;
    squared = squared + square(form);
  }
  bloat.interval_length += squared_length(hull).hi;
  bloat.affine_length += squared.range().hi;
}

double width(const numeric::IntervalVector& v) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += static_cast<double>(v[axis].hi) - v[axis].lo;
  return sum;
}

void add_moment(std::span<const Ray> rays, PacketBloat& bloat) {
  const Lines lines = make_lines(rays, Scale::MajorAxis);
  auto origins = numeric::IntervalVector::nothing(), directions = origins, moments = origins;
  for (const cull::packet::Line& line : lines.lines) {
    origins = unite(origins, line.origin);
    directions = unite(directions, line.direction);
    moments = unite(moments, cross(line.origin, line.direction));
  }
  const double own = width(moments);
  if (!(own > 0) || lines.shared_origin) return;
  ++bloat.wide_packets;
  bloat.interval_moment += width(cross(origins, directions)) / own;
  bloat.affine_moment += width(cull::packet::AffineBounds(lines).moments()) / own;
}

void add_bloat(std::span<const Ray> rays, PacketBloat& bloat) {
  ++bloat.packets;
  add_length(rays, bloat);
  add_moment(rays, bloat);
}

/// The hits of one chunk of rays, beside those that the rays find alone.
void judge_hits(const HitJudge& judge, std::span<const Ray> rays, std::span<const Hit> alone, std::span<const Hit> hits,
                PacketWork& work) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (same_bits(alone[i], hits[i])) continue;
    switch (judge.judge(rays[i], alone[i], hits[i])) {
      case Verdict::Lost:
        ++work.lost_hits;
        break;
      case Verdict::NearMiss:
        ++work.near_misses;
        break;
      case Verdict::Tie:
        ++work.ties;
        break;
    }
  }
}

/// Packets of one scene's rays, chunk by chunk.
class Measuring {
 public:
  Measuring(const scene::Scene& scene, const accel::Bvh4& bvh, const RaySample& sample,
            const PacketMeasureOptions& options)
      : judge_(scene.mesh), bvh_(bvh), sample_(sample), options_(options) {}

  PacketWork work(Method method, std::size_t first, std::size_t last) const {
    PacketWork work;
    trace({.method = method, .least_rays = options_.least_rays}, first, last, work);
    return work;
  }

  PacketResult all(std::size_t first, std::size_t last) const {
    PacketResult result;
    const std::span<const Ray> rays(sample_.rays.data() + first, last - first);
    result.rays = rays.size();
    reference::StepList steps;
    const reference::Traversal alone(bvh_, nullptr, none_);
    for (const Ray& ray : rays) alone.trace(ray, &steps);
    result.single = count_steps(steps, 0, steps.rays());
    AllMethods observer(result);
    PacketWork unculled;
    trace({.culls = false, .least_rays = options_.least_rays}, first, last, unculled, &observer);
    for (std::size_t m = 0; m < kPacketMethods; ++m) result.work[m] = work(kMethods[m], first, last);
    for (const auto& members : form_packets(rays, options_.forming)) {
      std::vector<Ray> packet;
      for (const std::uint32_t i : members) packet.push_back(rays[i]);
      add_bloat(packet, result.bloat);
    }
    return result;
  }

  /// The sum of `part(first, last)` over all chunks, in their order.
  template <class Part>
  auto over_chunks(const Part& part) const {
    const std::size_t chunk = kWindowsPerChunk * static_cast<std::size_t>(options_.forming.window);
    const std::size_t chunks = (sample_.rays.size() + chunk - 1) / chunk;
    std::vector<decltype(part(0, 0))> parts(chunks);
    parallel_chunks(sample_.rays.size(), chunk, options_.threads,
                    [&](std::size_t first, std::size_t last) { parts[first / chunk] = part(first, last); });
    decltype(part(0, 0)) sum;
    for (const auto& one : parts) sum += one;
    return sum;
  }

 private:
  void trace(const reference::PacketOptions& options, std::size_t first, std::size_t last, PacketWork& work,
             reference::PacketObserver* observer = nullptr) const {
    const std::span<const Ray> rays(sample_.rays.data() + first, last - first);
    std::vector<Hit> hits(rays.size());
    reference::PacketTraversal(bvh_, nullptr, none_, options)
        .trace(rays, options_.forming, hits, work.counts, observer);
    judge_hits(judge_, rays, {sample_.hits.data() + first, rays.size()}, hits, work);
  }

  const HitJudge judge_;
  const cull::MaskTester none_{cull::Design::None, {}};
  const accel::Bvh4& bvh_;
  const RaySample& sample_;
  const PacketMeasureOptions& options_;
};

}  // namespace

PacketFindings& PacketFindings::operator+=(const PacketFindings& other) {
  questions += other.questions;
  all_miss += other.all_miss;
  found_by_some += other.found_by_some;
  lost += other.lost;
  for (std::size_t m = 0; m < kPacketMethods; ++m) {
    found[m] += other.found[m];
    operations[m] += other.operations[m];
  }
  return *this;
}

PacketWork& PacketWork::operator+=(const PacketWork& other) {
  counts += other.counts;
  lost_hits += other.lost_hits;
  near_misses += other.near_misses;
  ties += other.ties;
  return *this;
}

PacketBloat& PacketBloat::operator+=(const PacketBloat& other) {
  packets += other.packets;
  interval_length += other.interval_length;
  affine_length += other.affine_length;
  wide_packets += other.wide_packets;
  interval_moment += other.interval_moment;
  affine_moment += other.affine_moment;
  return *this;
}

PacketResult& PacketResult::operator+=(const PacketResult& other) {
  rays += other.rays;
  single += other.single;
  boxes += other.boxes;
  triangles += other.triangles;
  spheres += other.spheres;
  parts += other.parts;
  bloat += other.bloat;
  for (std::size_t m = 0; m < kPacketMethods; ++m) {
    building[m] += other.building[m];
    work[m] += other.work[m];
  }
  return *this;
}

std::uint64_t PacketResult::wrong() const {
  std::uint64_t sum = boxes.lost + triangles.lost + spheres.lost;
  for (const PacketWork& one : work) sum += one.lost_hits;
  return sum;
}

PacketResult measure_packets(const scene::Scene& scene, const accel::Bvh4& bvh, const RaySample& sample,
                             const PacketMeasureOptions& options) {
  const Measuring measuring(scene, bvh, sample, options);
  return measuring.over_chunks([&](std::size_t first, std::size_t last) { return measuring.all(first, last); });
}

PacketWork measure_packet_work(const scene::Scene& scene, const accel::Bvh4& bvh, const RaySample& sample,
                               Method method, const PacketMeasureOptions& options) {
  const Measuring measuring(scene, bvh, sample, options);
  return measuring.over_chunks(
      [&](std::size_t first, std::size_t last) { return measuring.work(method, first, last); });
}

}  // namespace ctu::sim::paper
