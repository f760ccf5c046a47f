// The tables of `ctusim metamorph`.
#pragma once

#include <string>
#include <vector>

#include "sim/metamorph/scene_check.h"

namespace ctu::sim::metamorph {

struct NamedReport {
  std::string scene;
  SceneReport report;
};

/// A line for each transformation, then the edges; as soon as a scene is done.
void print_header();
void print_scene(const NamedReport& named);

/// Two Markdown tables: a row for each scene and kind of transformation, and a row for each scene with closed parts.
void print_markdown(const std::vector<NamedReport>& reports);

/// All of it, for tools. Throws Error when the file cannot be written.
void write_json(const std::vector<NamedReport>& reports, const std::string& path);

/// What was left out, and every defect, on stderr.
void print_remarks(const NamedReport& named);

}  // namespace ctu::sim::metamorph
