#include <algorithm>

#include "tests/fuzz/argument_inputs.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/numeric_inputs.h"
#include "tests/fuzz/scene_inputs.h"
#include "tests/fuzz/trace_inputs.h"

namespace ctu::fuzz {
namespace {

constexpr Harness kHarnesses[] = {
    {"obj", "a Wavefront OBJ", 4096, [](Input input) { load_scene("obj", input); }},
    {"ply", "a PLY, text or binary", 4096, [](Input input) { load_scene("ply", input); }},
    {"gltf", "a glTF as text", 6144, [](Input input) { load_scene("gltf", input); }},
    {"glb", "a binary glTF", 6144, [](Input input) { load_scene("glb", input); }},
    {"pbrt", "a pbrt scene beside files that it may name", 4096, [](Input input) { load_scene("pbrt", input); }},
    {"scn", "a LuxCore scene beside files that it may name", 2048, [](Input input) { load_scene("scn", input); }},
    {"hair", "a .hair", 4096, [](Input input) { load_scene("hair", input); }},
    {"tfx", "a TressFX .tfx", 4096, [](Input input) { load_scene("tfx", input); }},
    {"nff", "an NFF", 4096, [](Input input) { load_scene("nff", input); }},
    {"list", "a .list beside files that it may name", 1024, [](Input input) { load_scene("list", input); }},
    {"zst", "a scene compressed with zstd", 4096, [](Input input) { load_scene("obj.zst", input); }},
    {"generated", "the name of a generated scene, behind gen:", 256, load_generated},
    {"trace_file", "a trace whose checksums are put right", 32768, read_trace_file},
    {"trace_content", "changes to a trace that is written with right checksums, sliced and run", 512,
     read_changed_trace},
    {"manifest", "the JSON of a trace", 12288, read_manifest},
    {"toml", "a configuration file", 4096, read_config},
    {"set", "--set assignments, one a line", 512, read_assignments},
    {"options", "options of a scene, NAME VALUE on each line", 512, read_options},
    {"index", "an index of scenes", 1024, read_index},
    {"round", "operations, each against exact rationals", 440, check_operations},
    {"boxes", "rays and boxes against exact rationals: the slab test and the cells of every design", 256, check_boxes},
    {"triangles", "rays and triangles against the stated roundings in exact rationals", 256, check_triangles},
};

}  // namespace

std::span<const Harness> harnesses() { return kHarnesses; }

const Harness* find_harness(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kHarnesses), std::end(kHarnesses), [&](const Harness& h) { return h.name == name; });
  return found == std::end(kHarnesses) ? nullptr : found;
}

}  // namespace ctu::fuzz
