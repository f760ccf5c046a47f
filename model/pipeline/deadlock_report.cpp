#include "model/pipeline/deadlock_report.h"

#include <fmt/format.h>

namespace ctu::pipeline {

std::string deadlock_report(Cycle now, Cycle last_moved, const Probes& probes, const Contexts& contexts) {
  std::string text = fmt::format("deadlock: nothing moved from cycle {} to {}\n", last_moved, now);
  const Context* oldest = nullptr;
  Stay stay;
  for (int slot = 0; slot < contexts.count(); ++slot) {
    const Context& context = contexts[slot];
    if (!context.in_flight || (oldest != nullptr && context.ray > oldest->ray)) continue;
    oldest = &context;
    stay = contexts.stay(slot);
  }
  if (oldest != nullptr)
    text += fmt::format(
        "oldest ray: {}, in the unit since cycle {}, at {} since cycle {}, {} visits done, {} stack entries\n",
        oldest->ray, oldest->entered, name_of(stay.place), stay.since, oldest->visits, oldest->depth);
  text += "links (entries, valid, ready):\n";
  for (const LinkProbe& link : probes.links)
    text += fmt::format("  {:<20} {} {} {}{}\n", link.name, link.occupancy(), link.valid(now) ? "valid" : "-    ",
                        link.ready(now) ? "ready" : "-    ",
                        !link.ready(now) && link.occupancy() < 2 ? "   <- refuses although it has room" : "");
  text += "stages:\n";
  for (const Account* stage : probes.stages)
    text += fmt::format("  {:<20} {}\n", stage->stage(), name_of(stage->current()));
  return text;
}

}  // namespace ctu::pipeline
