#include "sim/tailor/workbench.h"

#include <algorithm>
#include <utility>

#include "model/base/error.h"
#include "model/base/parallel.h"
#include "model/pipeline/parameter.h"
#include "model/unit/run.h"
#include "sim/config_file.h"
#include "sim/energy/cost_report.h"

namespace ctu::tailor {
namespace {

constexpr std::uint64_t kParts = 8;  ///< of a sample, spread over the trace

/// Blocks read before, as a feed.
class KeptFeed : public reference::RayFeed {
 public:
  using Blocks = std::vector<std::shared_ptr<const reference::RayBlock>>;
  KeptFeed(const Blocks& blocks, std::uint64_t rays, const reference::PacketPlan& packets)
      : blocks_(blocks), rays_(rays), packets_(packets) {}
  std::shared_ptr<const reference::RayBlock> next() override {
    return next_ == blocks_.size() ? nullptr : blocks_[next_++];
  }
  std::uint64_t total_rays() const override { return rays_; }
  reference::PacketPlan packets() const override { return packets_; }

 private:
  const Blocks& blocks_;
  std::uint64_t rays_;
  reference::PacketPlan packets_;
  std::size_t next_ = 0;
};

}  // namespace

/// A design's tester, image and walked rays of one trace.
struct Workbench::Prepared {
  cull::MaskTester tester;
  accel::Image image;
  KeptFeed::Blocks blocks;
  energy::UnitShape shape;  ///< in some configuration
};

struct Workbench::Bench {
  explicit Bench(const std::string& path) : trace(path) {}
  sim::LoadedTrace trace;
  std::vector<traces::RayRange> ranges;  ///< the sample
  std::uint64_t rays() const {
    std::uint64_t sum = 0;
    for (const traces::RayRange& range : ranges) sum += range.last - range.first;
    return sum;
  }
  std::map<cull::Design, std::unique_ptr<Prepared>> designs;
};

Workbench::Workbench(const std::vector<std::string>& traces, std::uint64_t rays) {
  for (const std::string& path : traces) {
    auto bench = std::make_unique<Bench>(path);
    const std::uint64_t all = bench->trace.reader().rays();
    const bool whole = rays == 0 || rays >= all;
    // Packets must not be cut: one part, from the trace's begin.
    const bool packets = bench->trace.reader().manifest().packets.any();
    const std::uint64_t parts = whole || packets ? 1 : kParts;
    for (std::uint64_t part = 0; part < parts; ++part) {
      const std::uint64_t count = whole ? all : rays / parts + (part < rays % parts);
      if (count == 0) continue;
      const std::uint64_t space = all / parts;
      const std::uint64_t first = parts == 1 ? 0 : part * space + (space - std::min(space, count)) / 2;
      bench->ranges.push_back(bench->trace.range(first, whole ? 0 : count));
    }
    benches_.push_back(std::move(bench));
  }
}

Workbench::~Workbench() = default;

const sim::LoadedTrace& Workbench::trace(std::size_t i) const { return benches_[i]->trace; }
std::uint64_t Workbench::sampled(std::size_t i) const { return benches_[i]->rays(); }

bool Workbench::has_masks_for(cull::Design design) const {
  return std::all_of(benches_.begin(), benches_.end(), [&](const auto& bench) {
    if (design == cull::Design::None) return true;
    if (bench->trace.masks().bits.empty()) return false;
    return design != cull::Design::BitTable || bench->trace.mask_options().entries > 0;
  });
}

const Workbench::Prepared& Workbench::prepared(Bench& bench, cull::Design design) {
  std::unique_ptr<Prepared>& kept = bench.designs[design];
  if (kept == nullptr) {
    auto made =
        std::make_unique<Prepared>(Prepared{bench.trace.tester(design), bench.trace.unit_image(design), {}, {}});
    const reference::PacketPlan packets = bench.trace.reader().manifest().packets.plan;
    pipeline::UnitConfig config;
    config.mask_test.design = design;
    made->shape = energy::unit_shape(config, made->image, made->tester, packets.size, packets.most_entries);
    for (const traces::RayRange& range : bench.ranges) {
      traces::TraceFeed feed(bench.trace.reader(), range, bench.trace.bvh(), &bench.trace.masks(), made->tester);
      while (auto block = feed.next()) made->blocks.push_back(std::move(block));
    }
    kept = std::move(made);
  }
  return *kept;
}

energy::UnitShape Workbench::shape(std::size_t i, const pipeline::UnitConfig& config) {
  const std::lock_guard lock(mutex_);
  Bench& bench = *benches_[i];
  const Prepared& work = prepared(bench, config.mask_test.design);
  energy::UnitShape needed = work.shape;
  energy::set_config(needed, config, work.tester);
  return needed;
}

double Workbench::area(const pipeline::UnitConfig& config) {
  const energy::EnergyTable& table = energy::EnergyTable::standard();
  double largest = 0;
  for (std::size_t i = 0; i < traces(); ++i) {
    const energy::UnitShape needed = shape(i, config);
    const auto memory = static_cast<double>(bits_of(energy::on_chip_structures(needed), energy::Keeping::Memory));
    largest = std::max(largest, memory * table.at("area.memory_bit") +
                                    energy::GateTable::standard().of(needed).gate_equivalents * table.at("area.gate"));
  }
  return largest;
}

Trial Workbench::measure(const pipeline::UnitConfig& config) {
  Trial trial;
  try {
    pipeline::check_consistency(config);
    for (const auto& bench : benches_) {
      const Prepared* work = nullptr;
      {
        const std::lock_guard lock(mutex_);
        work = &prepared(*bench, config.mask_test.design);
      }
      KeptFeed feed(work->blocks, bench->rays(), bench->trace.reader().manifest().packets.plan);
      const pipeline::UnitResult result =
          unit::run(config, {work->image, work->tester, feed}, {.mode = unit::Mode::Plain});
      if (result.wrong_hits != 0) throw Error(bench->trace.reader().path(), "a hit is wrong", "report it");
      trial.cycles.push_back(result.cycles);
    }
  } catch (const Error& error) {
    trial.refusal = error.problem();
  } catch (const unit::Deadlock&) {
    trial.refusal = "deadlock";
  }
  return trial;
}

const Trial& Workbench::run(const pipeline::UnitConfig& config) {
  run_all({config}, 1);
  return trials_.at(sim::config_hash(config));
}

void Workbench::run_all(const std::vector<pipeline::UnitConfig>& configs, int threads) {
  std::vector<const pipeline::UnitConfig*> fresh;
  std::map<std::string, bool> planned;
  for (const pipeline::UnitConfig& config : configs) {
    const std::string hash = sim::config_hash(config);
    if (!trials_.contains(hash) && !std::exchange(planned[hash], true)) fresh.push_back(&config);
  }
  std::vector<Trial> trials(fresh.size());
  parallel_chunks(fresh.size(), 1, threads, [&](std::size_t i, std::size_t) { trials[i] = measure(*fresh[i]); });
  for (std::size_t i = 0; i < fresh.size(); ++i) trials_[sim::config_hash(*fresh[i])] = std::move(trials[i]);
}

}  // namespace ctu::tailor
