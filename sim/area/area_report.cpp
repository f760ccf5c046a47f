#include "sim/area/area_report.h"

#include <algorithm>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "model/base/parallel.h"
#include "sim/area/area_cache.h"
#include "sim/area/elaboration.h"
#include "sim/area/memory_macro.h"
#include "sim/area/netlist.h"

namespace ctu::area {
namespace {

std::vector<std::filesystem::path> sources_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> sources;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, none))
    if (entry.path().extension() == ".sv" || entry.path().extension() == ".svh") sources.push_back(entry.path());
  std::sort(sources.begin(), sources.end());
  return sources;
}

/// Everything that the elaborated unit depends on.
std::string unit_key(const std::vector<std::filesystem::path>& sources, const Yosys& yosys, const AreaJob& job) {
  Hasher hasher;
  hasher.add(yosys.version() + job.top);
  for (const auto& [name, value] : job.parameters) hasher.add(fmt::format("{}={},", name, value));
  for (const auto& source : sources) {
    std::ifstream in(source, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    hasher.add(source.lexically_relative(job.rtl).string() + '\n' + text.str());
  }
  return hasher.digest().hex();
}

/// Modules of one target: those of the cache, and those made now.
class Library {
 public:
  Library(const AreaJob& job, const Yosys& yosys, Target target)
      : yosys_(yosys), cache_(job.cache), target_(target), top_(job.top) {}

  /// What modules are, by name.
  void identify(std::map<std::string, std::string> identities) { identities_ = std::move(identities); }

  /// Whether the module is at hand; then at() gives it.
  bool has(const std::string& module) {
    if (modules_.contains(module)) return true;
    std::optional<ModuleArea> found = cache_.find(key(module));
    if (!found) return false;
    ++cached_;
    modules_[module] = std::move(*found);
    return true;
  }
  const ModuleArea& at(const std::string& module) const { return modules_.at(module); }

  bool has_all(const std::string& module) {
    if (!has(module)) return false;
    const ModuleArea& area = at(module);
    return std::all_of(area.instances.begin(), area.instances.end(),
                       [this](const auto& inner) { return has_all(inner.first); });
  }

  /// All of them, those inside before those around them; stages one after the other.
  void make(const Elaboration& rtl, const std::vector<std::string>& stages, const AreaJob& job) {
    std::vector<Batch> batches;
    std::set<std::string> planned;
    for (const std::string& stage : stages) {
      Batch batch{stage, {}, {}};
      for (const std::string& module : stage == top_ ? std::vector{stage} : rtl.with_inner(stage))
        if (!has(module) && !take_memory(module, rtl.at(module)) && planned.insert(module).second)
          batch.modules.insert(module);
      if (!batch.modules.empty()) batches.push_back(std::move(batch));
    }
    std::mutex mutex;
    std::size_t read = 0;  // netlists are read in order: a stage may need modules that an earlier one has brought
    parallel_chunks(batches.size(), 1, job.threads, [&](std::size_t first, std::size_t) {
      if (job.on_stage) job.on_stage(plain_name(batches[first].stage));
      std::string netlist = yosys_.synthesise(rtl.excerpt(batches[first].modules), target_);
      const std::lock_guard lock(mutex);
      batches[first].netlist = std::move(netlist);
      for (; read < batches.size() && !batches[read].netlist.empty(); ++read) take(batches[read]);
    });
  }

  std::uint64_t cached() const { return cached_; }
  std::uint64_t made() const { return made_; }

 private:
  struct Batch {
    std::string stage;
    std::set<std::string> modules;
    std::string netlist;
  };

  bool take_memory(const std::string& module, const ElaboratedModule& rtl) {
    const std::optional<ModuleArea> area = memory_macro(plain_name(module), rtl);
    if (area) keep(module, *area);
    return area.has_value();
  }

  void take(Batch& batch) {
    auto areas = read_netlist(batch.netlist, target_, [this](const std::string& module) -> const PortPaths* {
      const auto found = modules_.find(module);
      return found == modules_.end() ? nullptr : &found->second.paths;
    });
    batch.netlist = " ";  // read; its megabytes are not needed any more
    for (auto& [module, area] : areas) keep(module, std::move(area));
  }

  void keep(const std::string& module, ModuleArea area) {
    cache_.keep(key(module), area);
    modules_[module] = std::move(area);
    ++made_;
  }

  std::string key(const std::string& module) const {
    Hasher hasher;
    hasher.add(yosys_.version() + Yosys::synthesis_script(target_) + identities_.at(module));
    return hasher.digest().hex();
  }

  const Yosys& yosys_;
  AreaCache cache_;
  Target target_;
  std::string top_;
  std::map<std::string, std::string> identities_;
  std::map<std::string, ModuleArea> modules_;
  std::uint64_t cached_ = 0, made_ = 0;
};

void add_gates(Area& sum, const ModuleArea& module, std::uint64_t times) {
  std::uint64_t hundredths = 0;
  for (const auto& [type, count] : module.cells) {
    (is_flip_flop(type) ? sum.flip_flops : sum.gates) += count * times;
    hundredths += count * static_cast<std::uint64_t>(centigates(type));
  }
  sum.gate_equivalents += double(hundredths * times) / 100;
  for (const auto& [shape, count] : module.memories) sum.memories[shape] += count * times;
}

void add_fpga(FpgaArea& sum, const ModuleArea& module, std::uint64_t times) {
  const auto count = [&](const char* type) {
    const auto found = module.cells.find(type);
    return found == module.cells.end() ? 0 : found->second * times;
  };
  sum.lut4 += count("LUT4") + 2 * count("CCU2C") + 4 * count("TRELLIS_DPR16X4");
  sum.flip_flops += count("TRELLIS_FF");
  sum.dsps += count("MULT18X18D");
  sum.block_rams += count("DP16KD");
}

template <class Add>
void add_with_inner(const Library& library, const std::string& name, std::uint64_t times, const Add& add) {
  const ModuleArea& module = library.at(name);
  add(module, times);
  for (const auto& [inner, count] : module.instances) add_with_inner(library, inner, count * times, add);
}

StageArea& stage_of(AreaReport& report, const std::string& module) {
  const auto found = std::find_if(report.stages.begin(), report.stages.end(),
                                  [&](const StageArea& stage) { return stage.module == plain_name(module); });
  if (found != report.stages.end()) return *found;
  report.stages.push_back({plain_name(module), 0, {}});
  return report.stages.back();
}

class Reporter {
 public:
  explicit Reporter(const AreaJob& job) : job_(job), yosys_(job.yosys), sources_(sources_in(job.rtl)) {
    const auto is_top = [&](const auto& source) { return source.filename() == job.top + ".sv"; };
    if (std::none_of(sources_.begin(), sources_.end(), is_top))
      throw Error(job.rtl.string(), fmt::format("{}.sv is not there", job.top),
                  "give the folder of the RTL's sources with --rtl");
    gates_.emplace(job, yosys_, Target::Gates);
    if (job.fpga) fpga_.emplace(job, yosys_, Target::Ecp5);
  }

  AreaReport report() {
    AreaReport report;
    const AreaCache cache(job_.cache);
    const std::string unit = unit_key(sources_, yosys_, job_);
    const auto identities = cache.find_identities(unit);
    if (identities) identify(*identities);
    if (identities && job_.stages.empty() && gates_->has_all(job_.top) && (!fpga_ || fpga_->has_all(job_.top))) {
      for (const auto& [module, count] : gates_->at(job_.top).instances) add(report, module, count);
      add_top(report);
    } else {
      const Elaboration rtl(yosys_.elaborate(sources_, job_.top, job_.parameters));
      identify(rtl.identities(job_.top));
      cache.keep_identities(unit, rtl.identities(job_.top));
      synthesise(rtl, report);
    }
    std::sort(report.stages.begin(), report.stages.end(),
              [](const StageArea& a, const StageArea& b) { return a.module < b.module; });
    report.cached = gates_->cached() + (fpga_ ? fpga_->cached() : 0);
    report.synthesised = gates_->made() + (fpga_ ? fpga_->made() : 0);
    return report;
  }

 private:
  bool is_wanted(const std::string& module) const {
    const auto& wanted = job_.stages;
    return wanted.empty() || std::find(wanted.begin(), wanted.end(), plain_name(module)) != wanted.end();
  }

  void identify(const std::map<std::string, std::string>& identities) {
    gates_->identify(identities);
    if (fpga_) fpga_->identify(identities);
  }

  void synthesise(const Elaboration& rtl, AreaReport& report) {
    std::map<std::string, std::uint64_t> stages;
    for (const std::string& module : rtl.at(job_.top).instances)
      if (is_wanted(module)) ++stages[module];
    for (const std::string& name : job_.stages)
      if (std::none_of(stages.begin(), stages.end(), [&](const auto& s) { return plain_name(s.first) == name; }))
        throw Error("--stages", fmt::format("the unit has no stage {}", name), "stages are named as files of rtl/");
    std::vector<std::string> names;
    for (const auto& [module, count] : stages) names.push_back(module);
    if (job_.stages.empty()) names.push_back(job_.top);
    gates_->make(rtl, names, job_);
    if (fpga_) fpga_->make(rtl, names, job_);
    for (const auto& [module, count] : stages) add(report, module, count);
    if (job_.stages.empty()) add_top(report);
  }

  void add(AreaReport& report, const std::string& module, std::uint64_t count) const {
    StageArea& stage = stage_of(report, module);
    stage.instances += count;
    stage.area.depth = std::max(stage.area.depth, gates_->at(module).paths.longest());
    report.total.depth = std::max(report.total.depth, stage.area.depth);
    const auto add_to = [&](Area& area) {
      add_with_inner(*gates_, module, count, [&](const auto& m, auto times) { add_gates(area, m, times); });
      if (fpga_)
        add_with_inner(*fpga_, module, count, [&](const auto& m, auto times) { add_fpga(area.fpga, m, times); });
    };
    add_to(stage.area);
    add_to(report.total);
  }

  /// What joins the stages.
  void add_top(AreaReport& report) const {
    add_gates(report.total, gates_->at(job_.top), 1);
    if (fpga_) add_fpga(report.total.fpga, fpga_->at(job_.top), 1);
    report.total.depth = gates_->at(job_.top).paths.longest();
  }

  const AreaJob& job_;
  Yosys yosys_;
  std::vector<std::filesystem::path> sources_;
  std::optional<Library> gates_, fpga_;
};

}  // namespace

std::uint64_t Area::memory_bits() const {
  std::uint64_t bits = 0;
  for (const auto& [shape, count] : memories) bits += shape.bits() * count;
  return bits;
}

AreaReport area_of(const AreaJob& job) { return Reporter(job).report(); }

}  // namespace ctu::area
