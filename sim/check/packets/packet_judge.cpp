#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "model/cull/packet/packet_slabs.h"
#include "sim/check/packets/packet_campaign.h"
#include "sim/exact_meeting.h"

namespace ctu::sim::check {
namespace {

using cull::packet::Answer;
using cull::packet::Bounds;
using cull::packet::Lines;
using cull::packet::Method;
using cull::packet::Reach;
using intersect::Ray;
using sim::meets;

/// The triangle a part of its way along; false where a coordinate there is no binary32 number.
bool moved(const cull::packet::MovingTriangle& moving, double part, cull::packet::Triangle& out) {
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double from = moving.start.vertex[i][axis], to = moving.end.vertex[i][axis];
      const double step = (to - from) * part, at = from + step;
      out.vertex[i][axis] = static_cast<float>(at);
      const bool exact = from + (to - from) == to && to - (to - from) == from && at - from == step && at - step == from;
      if (!exact || out.vertex[i][axis] != at) return false;
    }
  return true;
}

/// At the quarters of its way, as far as they can be asked exactly.
bool meets(oracle::RayOracle& ray, const cull::packet::MovingTriangle& moving) {
  if (meets(ray, moving.start) || meets(ray, moving.end)) return true;
  cull::packet::Triangle triangle;
  for (const double part : {0.25, 0.5, 0.75})
    if (moved(moving, part, triangle) && meets(ray, triangle)) return true;
  return false;
}

/// Which rays meet it, from tmin to tmax and to where they may still reach.
template <class Primitive>
struct ExactAnswer {
  int first_meeting = -1;  ///< of the shortened rays
  int first_missing = -1;  ///< of the rays as they are

  ExactAnswer(const PacketCase& packet, const Primitive& primitive) {
    for (std::size_t i = 0; i < packet.rays.size(); ++i) {
      Ray ray = packet.rays[i];
      oracle::RayOracle whole(ray);
      const bool met = meets(whole, primitive);
      if (!met && first_missing < 0) first_missing = static_cast<int>(i);
      if (!met || first_meeting >= 0) continue;
      ray.tmax = packet.limits[i];
      oracle::RayOracle shortened(ray);
      if (packet.limits[i] == packet.rays[i].tmax || meets(shortened, primitive)) first_meeting = static_cast<int>(i);
    }
  }
};

struct Asked {
  Method method;
  Bounds bounds;
  Reach reach;
};

/// The packet as the unit knows it, of the rays that still reach anywhere.
cull::packet::PacketSlabs unit_packet(const PacketCase& packet) {
  cull::packet::PacketSlabs slabs;
  for (std::size_t i = 0; i < packet.rays.size(); ++i) {
    Ray ray = packet.rays[i];
    ray.tmax = packet.limits[i];
    const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
    if (prepared.valid) slabs.add(prepared);
  }
  return slabs;
}

/// Where it has no test for such a primitive it must ask each ray.
template <class Primitive>
Answer unit_answer(const cull::packet::PacketSlabs&, const Primitive&) {
  return Answer::Undecided;
}
Answer unit_answer(const cull::packet::PacketSlabs& packet, const cull::packet::Box& box) {
  if (packet.empty()) return Answer::AllMiss;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  intersect::Box4 boxes;
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      boxes.lo[axis][lane] = lane == 0 ? box.lo[axis] : kInfinity;
      boxes.hi[axis][lane] = lane == 0 ? box.hi[axis] : -kInfinity;
    }
  return packet.test(boxes).hit == 0 ? Answer::AllMiss : Answer::Undecided;
}

std::vector<Asked> ask_all(const PacketCase& packet) {
  std::vector<Asked> asked;
  const Lines as_given = make_lines(packet.rays, cull::packet::Scale::AsGiven),
              by_axis = make_lines(packet.rays, cull::packet::Scale::MajorAxis);
  for (const Method method : cull::packet::kMethods) {
    const Lines& lines = scale_of(method) == cull::packet::Scale::AsGiven ? as_given : by_axis;
    Reach reach = Reach::none();
    for (std::size_t i = 0; i < packet.rays.size(); ++i) lines.extend(reach, i, packet.limits[i]);
    asked.push_back({method, Bounds(method, lines), reach});
  }
  return asked;
}

std::string describe(const PacketCase& packet, int ray) {
  const Ray& r = packet.rays[static_cast<std::size_t>(ray)];
  return fmt::format("ray {} of {}: origin {:a} {:a} {:a} direction {:a} {:a} {:a} t [{:a}, {:a}] reach {:a}", ray,
                     packet.rays.size(), r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y,
                     r.direction.z, r.tmin, r.tmax, packet.limits[static_cast<std::size_t>(ray)]);
}

}  // namespace

void judge_packet(std::uint64_t seed, std::uint32_t generator, std::uint64_t number, PacketTallies& tallies,
                  std::vector<PacketFailure>& failures, std::size_t kept) {
  const PacketCase packet = make_packet_case(seed, generator, number);
  const std::vector<Asked> asked = ask_all(packet);
  const cull::packet::PacketSlabs unit = unit_packet(packet);
  const auto judge = [&](std::size_t kind, const auto& primitive) {
    const ExactAnswer exact(packet, primitive);
    PacketTally& tally = tallies[kind];
    ++tally.packets;
    tally.rays += packet.rays.size();
    tally.all_miss += exact.first_meeting < 0;
    tally.all_hit += exact.first_missing < 0;
    const auto hold_to = [&](std::size_t method, Answer answer) {
      PacketAnswers& answers = tally.by_method[method];
      const bool lost = answer == Answer::AllMiss && exact.first_meeting >= 0;
      const bool invented = answer == Answer::AllHit && exact.first_missing >= 0;
      answers.all_miss += answer == Answer::AllMiss;
      answers.all_hit += answer == Answer::AllHit;
      answers.lost += lost;
      answers.invented += invented;
      if ((lost || invented) && failures.size() < kept)
        failures.push_back(
            {generator, number,
             fmt::format("{}: {} says that all rays {} the {}, but {}", packet_generators()[generator].name,
                         judged_method_name(method), lost ? "miss" : "meet", kPacketPrimitives[kind],
                         describe(packet, lost ? exact.first_meeting : exact.first_missing))});
    };
    for (const Asked& one : asked) hold_to(static_cast<std::size_t>(one.method), one.bounds.test(primitive, one.reach));
    hold_to(kUnitMethod, unit_answer(unit, primitive));
  };
  judge(0, packet.box);
  judge(1, packet.triangle);
  judge(2, packet.sphere);
  judge(3, packet.moving);
}

}  // namespace ctu::sim::check
