#include "sim/sweep/trace_recorder.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/cli.h"
#include "sim/sweep/durable.h"
#include "sim/sweep/process_pool.h"

namespace ctu::sweep {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& words) {
  std::string text = "ctusim";
  for (const std::string& word : words) text += " " + word;
  return text + "\n";
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// In a process of its own: `ctusim record` as from the command line.
std::string record(const std::vector<std::string>& words, const std::string& output) {
  std::vector<std::string> all = {"ctusim"};
  all.insert(all.end(), words.begin(), words.end());
  all.insert(all.end(), {"-o", output});
  std::vector<const char*> pointers;
  for (const std::string& word : all) pointers.push_back(word.c_str());
  const int code = sim::run_cli(static_cast<int>(pointers.size()), pointers.data());
  if (code != 0) throw Error("record", fmt::format("ended with exit code {}", code), "");
  return {};
}

/// What was recorded and how, side by side: a trace without its command is not whole.
bool is_recorded(const fs::path& file, const TraceSource& trace) {
  return fs::exists(file) && text_of(file.string() + ".command") == joined(trace.record_words);
}

void record_into(const SweepFolder& folder, const TraceSource& trace, const fs::path& file,
                 const std::function<bool()>& stop) {
  fmt::print("recording {}\n", trace.name);
  const fs::path command = file.string() + ".command", fresh = file.parent_path() / ("new-" + file.filename().string());
  fs::remove(command);
  std::string problem;
  PoolWork work;
  work.count = 1;
  work.prepare = [](std::size_t) {};
  work.run = [&](std::size_t) { return record(trace.record_words, fresh.string()); };
  work.on_exception = [](std::size_t) {
    try {
      throw;
    } catch (const std::exception& e) {
      fmt::print(stderr, "{}\n", e.what());
    }
    return 2;
  };
  work.end = [&](std::size_t, const Ended& ended) {
    if (ended.how != Ended::How::Returned)
      problem = ended.errors.empty() ? fmt::format("ended with code {}", ended.code) : ended.errors;
  };
  if (run_in_processes(work, {}, stop) == 0) {
    if (stop()) return;
    problem = "was ended from outside";
  }
  if (!problem.empty())
    throw Error(trace.name, problem.substr(0, problem.find_last_not_of('\n') + 1),
                "mend the [[record]] table; by itself: " + joined(trace.record_words));
  sync_file(fresh);
  fs::rename(fresh, file);
  folder.write_atomically(command, joined(trace.record_words));
}

}  // namespace

std::vector<TraceFacts> ready_traces(const Space& space, const SweepFolder& folder, const std::function<bool()>& stop) {
  std::vector<TraceFacts> facts;
  for (const TraceSource& trace : space.traces) {
    const fs::path file = trace.file.empty() ? folder.path() / trace.name : fs::path(trace.file);
    if (trace.file.empty() && !is_recorded(file, trace)) record_into(folder, trace, file, stop);
    if (stop()) return {};
    facts.push_back(read_trace_facts(trace.name, fs::absolute(file).string(), trace.scene));
  }
  return facts;
}

}  // namespace ctu::sweep
