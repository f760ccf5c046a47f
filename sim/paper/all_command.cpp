// `ctusim paper all`: the evaluations of all four papers, one after the other.
#include <algorithm>

#include <fmt/format.h>

#include "sim/commands.h"
#include "sim/paper/page_section.h"

namespace ctu::sim {

int paper_all_command(PaperAllArgs args) {
  for (SceneArgs* scene : {&args.subspace.scene, &args.raybox.scene, &args.packets.scene, &args.raydist.scene}) {
    scene->index = args.index;
    scene->threads = args.threads;
  }
  args.subspace.quick = args.raybox.quick = args.raydist.quick = args.quick;
  if (args.quick) args.packets.sample = 2048;
  args.subspace.output = args.output;
  if (!args.page.empty())
    for (const char* section : {"paper", "raybox", "packets", "raydist"}) paper::require_section(args.page, section);

  int exit_code = 0;
  const auto evaluate = [&](const char* paper, const char* section, auto&& command) {
    fmt::print("# {}\n\n", paper);
    const std::string text = paper::printed_by([&] { exit_code = std::max(exit_code, command()); });
    if (!args.page.empty()) paper::put_section(args.page, section, text);
  };
  evaluate("Subspace culling", "paper", [&] { return paper_subspace_command(args.subspace); });
  evaluate("Ray-box culling", "raybox", [&] { return paper_raybox_command(args.raybox); });
  evaluate("Packet culling", "packets", [&] { return paper_packets_command(args.packets); });
  evaluate("Ray distribution aware trees", "raydist", [&] { return paper_raydist_command(args.raydist); });
  return exit_code;
}

}  // namespace ctu::sim
