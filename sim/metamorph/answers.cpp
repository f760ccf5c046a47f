#include "sim/metamorph/answers.h"

#include <algorithm>

#include "model/base/parallel.h"
#include "model/reference/closest_hit.h"

namespace ctu::sim::metamorph {
namespace {

using intersect::Hit;
using intersect::Ray;
using reference::StepList;

template <class T>
bool same_part(const std::vector<T>& a, const std::vector<std::uint64_t>& first_a, const std::vector<T>& b,
               const std::vector<std::uint64_t>& first_b, std::size_t ray) {
  const auto at = [](const std::vector<T>& v, std::uint64_t i) { return v.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::equal(at(a, first_a[ray]), at(a, first_a[ray + 1]), at(b, first_b[ray]), at(b, first_b[ray + 1]));
}

bool same_steps(const StepList& a, const StepList& b, std::size_t ray, Keys keys) {
  return a.tail_dropped[ray] == b.tail_dropped[ray] && same_part(a.steps, a.first_step, b.steps, b.first_step, ray) &&
         same_part(a.met, a.first_met, b.met, b.first_met, ray) &&
         (keys == Keys::Ignored || same_part(a.keys, a.first_key, b.keys, b.first_key, ray));
}

}  // namespace

Answers ask(const reference::Traversal& traversal, const std::vector<Ray>& rays, int threads, Record record) {
  Answers answers;
  answers.hits.resize(rays.size());
  if (record == Record::HitsAndSteps) answers.steps.resize((rays.size() + kRaysPerChunk - 1) / kRaysPerChunk);
  parallel_chunks(rays.size(), kRaysPerChunk, threads, [&](std::size_t first, std::size_t last) {
    StepList* const steps = record == Record::HitsAndSteps ? &answers.steps[first / kRaysPerChunk] : nullptr;
    for (std::size_t i = first; i < last; ++i) answers.hits[i] = traversal.trace(rays[i], steps);
  });
  return answers;
}

std::vector<Hit> best_of_all_triangles(const accel::Bvh4& bvh, const std::vector<Ray>& rays, int threads) {
  const reference::FastTracer tracer(bvh);
  std::vector<Hit> hits(rays.size());
  parallel_chunks(rays.size(), kRaysPerChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) hits[i] = tracer.closest(rays[i]);
  });
  return hits;
}

std::uint64_t different_steps(const Answers& a, const Answers& b, Keys keys, const std::vector<bool>& asked) {
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < a.hits.size(); ++i)
    if (asked[i] && !same_steps(a.steps[i / kRaysPerChunk], b.steps[i / kRaysPerChunk], i % kRaysPerChunk, keys))
      ++different;
  return different;
}

std::uint64_t different_hits(const std::vector<Hit>& a, const std::vector<Hit>& b, const Transformation& transformation,
                             const std::vector<bool>& asked) {
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Hit image{transformation.time(a[i].t), a[i].u, a[i].v, a[i].primitive};
    if (asked[i] && !intersect::same_bits(image, b[i])) ++different;
  }
  return different;
}

}  // namespace ctu::sim::metamorph
