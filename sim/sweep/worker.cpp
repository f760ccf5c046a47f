#include "sim/sweep/worker.h"

#include <cstring>
#include <list>
#include <new>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/engine.h"
#include "model/unit/run.h"
#include "sim/loaded_trace.h"
#include "sim/run_json.h"
#include "sim/sweep/columns.h"
#include "sim/sweep/result_store.h"
#include "sim/sweep/row.h"
#include "sim/unit_runner.h"

namespace ctu::sweep {
namespace {

enum ExitCode { kRefused = 2, kDeadlock = 3, kOutOfMemory = 4, kCrashed = 5 };

/// The traces used last stay loaded; processes that were forked have their own view of one that is let go.
class TraceShelf {
 public:
  const sim::LoadedTrace& load(const TraceFacts& facts) {
    for (auto at = loaded_.begin(); at != loaded_.end(); ++at)
      if (at->reader().path() == facts.file) {
        loaded_.splice(loaded_.begin(), loaded_, at);
        return loaded_.front();
      }
    constexpr std::size_t kMostLoaded = 4;
    if (loaded_.size() == kMostLoaded) loaded_.pop_back();
    loaded_.emplace_front(facts.file);
    if (loaded_.front().reader().hash() != facts.hash)
      throw Error(facts.file, "is another trace than the one that the sweep was planned with",
                  "run the sweep again, which plans it anew");
    return loaded_.front();
  }

 private:
  std::list<sim::LoadedTrace> loaded_;
};

/// In the point's own process.
std::string run_point(const Point& point, const sim::LoadedTrace& trace) {
  sim::RunPlan plan;
  plan.engine = point.engine;
  plan.config = config_of(point);
  plan.range = trace.range(point.first_ray, point.rays);
  return sim::json_text(sim::run_plan(trace, plan));
}

/// Within a catch, in the point's own process.
int exit_code_of_exception() {
  const auto say = [](const char* text, int code) {
    fmt::print(stderr, "{}\n", text);
    return code;
  };
  try {
    throw;
  } catch (const Error& e) {
    return say(e.what(), kRefused);
  } catch (const unit::Deadlock& e) {
    return say(e.what(), kDeadlock);
  } catch (const pipeline::DeadlockFound& e) {
    return say(e.what(), kDeadlock);
  } catch (const std::bad_alloc&) {
    return say("out of memory; --memory gives a point more", kOutOfMemory);
  } catch (const std::length_error&) {
    return say("out of memory", kOutOfMemory);
  } catch (const std::exception& e) {
    return say(e.what(), kCrashed);
  }
}

/// The same on every machine: the trace by the name it has in the sweep.
std::string message_of(const Point& point, const Ended& ended) {
  std::string text = ended.errors;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (std::size_t at = 0; (at = text.find(point.trace.file, at)) != std::string::npos; at += point.trace.name.size())
    text.replace(at, point.trace.file.size(), point.trace.name);
  return text;
}

std::string failure_of(const Point& point, const Ended& ended, const PoolLimits& limits) {
  const std::string said = message_of(point, ended);
  const auto line = [&](const char* status, const std::string& message) {
    return failure_line(point, status, message);
  };
  switch (ended.how) {
    case Ended::How::TimedOut:
      return line("timeout", fmt::format("not done after {} s", limits.seconds));
    case Ended::How::Signalled:
      return line("crashed", fmt::format("ended by signal {} ({}){}{}", ended.code, strsignal(ended.code),
                                         said.empty() ? "" : ": ", said));
    default:
      break;
  }
  switch (ended.code) {
    case kRefused:
      return line("refused", said);
    case kDeadlock:
      return line("deadlock", said);
    case kOutOfMemory:
      return line("out-of-memory", said);
    default:
      return line("crashed", fmt::format("exit code {}{}{}", ended.code, said.empty() ? "" : ": ", said));
  }
}

/// Notes that this part has not told yet.
class NoteWriter {
 public:
  NoteWriter(const SweepFolder& folder, const std::string& part)
      : file_(folder.parts() / (part + ".columns.jsonl"), DurableFile::Open::Append) {}
  void append(const ColumnNotes& notes) {
    std::string text;
    for (const auto& [name, note] : notes)
      if (told_.insert(name).second) text += to_line(note) + "\n";
    if (!text.empty()) file_.append(text);
  }

 private:
  DurableFile file_;
  std::set<std::string> told_;
};

}  // namespace

WorkReport run_points(const SweepFolder& folder, const std::vector<Point>& points, const std::string& part,
                      const PoolLimits& limits, const std::function<bool()>& stop,
                      const std::function<void(std::size_t)>& progress) {
  PartWriter writer(folder, part);
  NoteWriter notes(folder, part);
  TraceShelf shelf;
  WorkReport report;
  PoolWork work;
  work.count = points.size();
  work.prepare = [&](std::size_t i) { shelf.load(points[i].trace); };
  work.run = [&](std::size_t i) { return run_point(points[i], shelf.load(points[i].trace)); };
  work.on_exception = [](std::size_t) { return exit_code_of_exception(); };
  work.end = [&](std::size_t i, const Ended& ended) {
    const Point& point = points[i];
    const bool returned = ended.how == Ended::How::Returned;
    if (returned) notes.append(notes_of_run(ended.returned));
    const std::string row = returned ? result_line(point, ended.returned) : failure_of(point, ended, limits);
    writer.append(row, timing_line(point, ended.returned, ended.seconds, ended.peak_bytes));
    ++report.done;
    if (!is_right_line(row)) ++report.failed;
    progress(report.done);
  };
  run_in_processes(work, limits, stop);
  return report;
}

}  // namespace ctu::sweep
