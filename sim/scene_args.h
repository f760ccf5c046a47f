// From the words of the command line to the options of the recorder.
#pragma once

#include <string>
#include <vector>

#include "model/cull/options.h"
#include "model/scene/scene.h"
#include "sim/commands.h"
#include "traces/recorder.h"

namespace ctu::sim {

/// "all" or one kind of rays, as names of kinds.
std::vector<std::string> ray_kinds(const std::string& list);

/// "none,mask-lut" as designs; Error on an unknown one, naming the nearest.
std::vector<cull::Design> parse_designs(const std::string& list);

/// L: "1" to "5", or "inf" for cull::kUnlimitedLevels; Error on anything else.
int parse_levels(const std::string& levels);

/// Throws Error when the design cannot have its tables with such masks: asked before any work.
void require_possible(cull::Design design, const cull::MaskOptions& masks);

/// Throws Error unless a coordinate of boxes can have so many bits.
void require_box_bits(std::uint32_t bits);

/// Everything of SceneArgs but the scenes' names; Error on a word or number that is not allowed.
traces::RecordOptions record_options(const SceneArgs& args);

/// Loads one scene and prints its warnings to stderr.
scene::Scene load_scene(const SceneArgs& args, const std::string& name);

}  // namespace ctu::sim
