#include "sim/timeline/ray_visit.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "model/accel/child_ref.h"

namespace ctu::sim {
namespace {

using pipeline::Event;
using pipeline::Place;
using pipeline::RayStay;

/// Before its first turn in the scheduler a ray is set up, and may wait for its packet and begin at its entries.
bool is_before_first_turn(const RayVisit& visit) {
  return visit.stays.front().place == Place::RaySetup &&
         std::none_of(visit.stays.begin(), visit.stays.end(),
                      [](const RayStay& stay) { return stay.place == Place::Scheduler; });
}

bool continues(const RayVisit& visit, const RayStay& stay) {
  if (visit.slot != stay.slot || visit.ray != stay.ray || visit.leaves() || stay.enters) return false;
  return stay.place != Place::Scheduler || is_before_first_turn(visit);
}

/// Of a packet's visit (packet_cull.h).
bool is_of_packet(const reference::Step& step) { return !step.is_leaf() && (step.detail & 0x8000u) != 0; }

/// The visit's outcome is known when the stack, hit_update or packet_cull has it: in a cycle of the visit. `by_ray`:
/// visits' events in the order of rays, then of cycles.
std::optional<Event> outcome_of(const RayVisit& visit, const std::vector<Event>& by_ray) {
  const auto event = std::lower_bound(by_ray.begin(), by_ray.end(), visit, [](const Event& e, const RayVisit& v) {
    return std::pair(e.ray, e.cycle) < std::pair(v.ray, v.begin());
  });
  if (event == by_ray.end() || event->ray != visit.ray || event->cycle >= visit.end()) return std::nullopt;
  return *event;
}

std::vector<Event> visit_events(const pipeline::Timeline& timeline) {
  std::vector<Event> events;
  std::copy_if(timeline.events().begin(), timeline.events().end(), std::back_inserter(events),
               [](const Event& event) { return !event.is_return; });
  std::sort(events.begin(), events.end(),
            [](const Event& a, const Event& b) { return std::pair(a.ray, a.cycle) < std::pair(b.ray, b.cycle); });
  return events;
}

std::string describe_leaf(const reference::Step& step) {
  const int primitives = accel::leaf_count(step.ref);
  return fmt::format("leaf of {} from primitive {}, {} tested, {}", primitives, accel::leaf_first(step.ref),
                     step.triangles_tested(), step.became_best() != 0 ? "hit" : "no hit");
}

}  // namespace

std::vector<RayVisit> ray_visits(const pipeline::Timeline& timeline) {
  std::vector<RayStay> stays = timeline.stays();
  std::sort(stays.begin(), stays.end(),
            [](const RayStay& a, const RayStay& b) { return std::tie(a.slot, a.begin) < std::tie(b.slot, b.begin); });
  std::vector<RayVisit> visits;
  for (const RayStay& stay : stays) {
    if (visits.empty() || !continues(visits.back(), stay)) {
      const bool follows = !visits.empty() && visits.back().slot == stay.slot && visits.back().ray == stay.ray &&
                           !visits.back().leaves();
      RayVisit& visit = visits.emplace_back();
      visit.ray = stay.ray;
      visit.slot = stay.slot;
      visit.follows = follows;
    }
    visits.back().stays.push_back(stay);
  }
  const std::vector<Event> events = visit_events(timeline);
  for (RayVisit& visit : visits) visit.outcome = outcome_of(visit, events);
  return visits;
}

bool is_all_culled(const RayVisit& visit) {
  if (!visit.outcome || visit.outcome->step.is_leaf() || is_of_packet(visit.outcome->step)) return false;
  return visit.outcome->step.box_hits() != 0 && visit.outcome->step.survivors() == 0;
}

std::string describe(const RayVisit& visit) {
  if (!visit.outcome) return "visit";
  const reference::Step& step = visit.outcome->step;
  const std::string number = fmt::format("visit {}: ", visit.outcome->visit);
  if (step.is_leaf()) return number + describe_leaf(step);
  if (is_of_packet(step))
    return fmt::format("packet's {}node {}, {} of {} children met", number, step.ref, std::popcount(step.survivors()),
                       std::popcount(step.box_hits()));
  return number + fmt::format("node {}, {} hit, {} culled", step.ref, std::popcount(step.box_hits()),
                              std::popcount(step.box_hits()) - std::popcount(step.survivors()));
}

}  // namespace ctu::sim
