// Failing cases on disk: each a trace of one ray, which `ctusim run` replays, and a text with the commands.
#pragma once

#include <cstdint>
#include <string>

#include "sim/check/campaign.h"
#include "sim/check/check_scene.h"

namespace ctu::sim::check {

/// Writes one ray of the scene as a trace of its own. The expected hit is that of brute force among the triangles that
/// the ray meets exactly; the trace holds no event sequences. Throws Error when the file cannot be written.
void write_one_ray_trace(const CheckScene& scene, std::uint32_t ray, std::uint64_t seed, const std::string& path);

/// What replays the trace on the engine ("reference", "cycle" or "rtl").
std::string replay_command(const CullingSetup& setup, const std::string& engine, const std::string& path);

/// "GENERATOR-SCENE-RAY".
std::string name_of(const Failure& failure);

}  // namespace ctu::sim::check
