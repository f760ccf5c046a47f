#include "sim/cosim/side_waves.h"

namespace ctu::cosim {

SideWaves::SideWaves(const std::string& path, const std::vector<std::string>& links,
                     const std::vector<std::string>& stages, pipeline::Cycle first, pipeline::Cycle last)
    : links_(links.size()), stage_names_(stages) {
  for (std::size_t i = 0; i < links.size(); ++i)
    probes_.links.push_back({links[i], [this, i](pipeline::Cycle) { return links_[i].state.valid; },
                             [this, i](pipeline::Cycle) { return links_[i].state.ready; },
                             [this, i] { return links_[i].occupancy; }});
  stages_.reserve(stages.size());
  for (const std::string& name : stage_names_) {
    stages_.emplace_back(name, std::initializer_list<pipeline::Activity>{});
    probes_.stages.push_back(&stages_.back());
  }
  writer_ = std::make_unique<pipeline::WaveWriter>(path, probes_, first, last);
}

void SideWaves::set_stage(std::size_t stage, int activity) {
  if (activity < pipeline::kActivities) stages_[stage].set(static_cast<pipeline::Activity>(activity));
}

void SideWaves::end_cycle(pipeline::Cycle now) {
  if (writer_->wants(now)) {
    writer_->sample_links(now);
    writer_->sample_stages(now);
  }
  for (WatchedLink& link : links_) link.occupancy += link.state.pushed - link.state.popped;
}

}  // namespace ctu::cosim
