#include "model/reference/traversal.h"
#include "sim/check/execution.h"

namespace ctu::sim::check {
namespace {

class ReferenceExecution : public Execution {
 public:
  Answers run(const CheckScene& scene, CaseRandom&) override {
    Answers answers;
    if (scene.setup.packets.any()) {
      reference::StepList steps;
      answers.hits = scene.packet_walk().trace(scene.traversal(), steps);
      return answers;
    }
    const reference::Traversal traversal = scene.traversal();
    answers.hits.reserve(scene.hard.rays.size());
    for (const intersect::Ray& ray : scene.hard.rays) answers.hits.push_back(traversal.trace(ray));
    return answers;
  }
};

}  // namespace

std::unique_ptr<Execution> make_reference_execution() { return std::make_unique<ReferenceExecution>(); }

}  // namespace ctu::sim::check
