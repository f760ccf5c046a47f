// The tables of "Ray-Box Culling for Tree Structures" as Markdown, the published numbers beside ours.
#pragma once

#include <string>
#include <vector>

#include "sim/paper/published_raybox.h"
#include "sim/paper/raybox_measure.h"

namespace ctu::sim::paper {

/// A scene of ours and the paper's that it is held against, with what differs.
struct RayboxRow {
  RayboxResult ours;
  const PublishedRaybox* paper = nullptr;
  std::string remark;
};

/// Scenes, Tables 2 and 3, what Figs. 4 to 7 show, split clipping and the 4-wide tree.
std::string raybox_report(const std::vector<RayboxRow>& rows);

}  // namespace ctu::sim::paper
