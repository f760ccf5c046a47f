#include "sim/sweep/result_store.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "sim/sweep/row.h"

namespace ctu::sweep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRows = ".jsonl";
constexpr const char* kTimings = ".timings.jsonl";

/// NAME.jsonl, and not NAME.timings.jsonl or the like.
bool has_rows(const fs::path& file) { return file.extension() == kRows && file.stem().extension().empty(); }

bool is_result(const std::string& status) { return status == kDone || status == kWrong; }

void add_line(const std::string& line, const std::string& where, StoredResults& results) {
  std::string id, status;
  try {
    const auto json = nlohmann::json::parse(line);
    json.at("id").get_to(id);
    json.at("status").get_to(status);
  } catch (const nlohmann::json::exception& e) {
    throw Error(where, fmt::format("no result of a sweep: {}", e.what()), "take that line out of the file");
  }
  ++results.lines;
  const auto known = results.line_of.find(id);
  if (known != results.line_of.end()) {
    ++results.repeated;
    const bool had_result = is_result(results.status_of[id]);
    if (had_result && is_result(status) && known->second != line)
      throw Error(where, fmt::format("another result of point {} than before", id),
                  "do not mix versions of ctusim in one folder; take one of the lines out and run the sweep again");
    if (had_result) return;
  }
  results.line_of[id] = line;
  results.status_of[id] = status;
}

}  // namespace

PartWriter::PartWriter(const SweepFolder& folder, const std::string& name)
    : lock_(folder.parts() / (name + ".lock")),
      cut_bytes_(cut_torn_line(folder.parts() / (name + kRows))),
      rows_(folder.parts() / (name + kRows), DurableFile::Open::Append),
      timings_(folder.parts() / (name + kTimings), DurableFile::Open::Append) {
  cut_torn_line(folder.parts() / (name + kTimings));
  if (cut_bytes_ != 0)
    fmt::print(stderr, "{}: cut off {} bytes of a line that was not written to its end; its point runs again\n",
               (folder.parts() / (name + kRows)).string(), cut_bytes_);
  sync_folder(folder.parts());
}

PartWriter::~PartWriter() {
  try {
    rows_.sync();
  } catch (const Error&) {  // the rows are with the system all the same
  }
}

void PartWriter::append(const std::string& row, const std::string& timing) {
  // A disk under load takes longer for a sync than many a point takes to run.
  constexpr auto kLongestUnsynced = std::chrono::milliseconds(250);
  rows_.append(row + "\n");
  if (const auto now = std::chrono::steady_clock::now(); now - last_sync_ > kLongestUnsynced) {
    rows_.sync();
    last_sync_ = now;
  }
  timings_.append(timing + "\n");
}

bool StoredResults::has_result(const std::string& id) const {
  const auto known = status_of.find(id);
  return known != status_of.end() && is_result(known->second);
}

StoredResults read_results(const SweepFolder& folder) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 34;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder.parts()))
    if (has_rows(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  StoredResults results;
  for (const fs::path& file : files) {
    const std::string text = read_file(file, kMostBytes, "move the file away and run the sweep again");
    std::size_t begin = 0, number = 1;
    for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1, ++number)
      add_line(text.substr(begin, end - begin), fmt::format("{}:{}", file.string(), number), results);
    if (begin != text.size()) ++results.torn_parts;
  }
  return results;
}

}  // namespace ctu::sweep
