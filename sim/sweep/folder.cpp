#include "sim/sweep/folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "sim/sweep/durable.h"

namespace ctu::sweep {

namespace fs = std::filesystem;

SweepFolder::SweepFolder(const fs::path& path, bool create) : path_(path) {
  std::error_code error;
  if (create) {
    fs::create_directories(parts(), error);
    fs::create_directories(traces(), error);
  }
  if (!fs::is_directory(parts()))
    throw Error(path.string(), create ? "the folder cannot be made" : "is no folder of a sweep",
                create ? "check the path and its permissions" : "`ctusim sweep run SPACE.toml -o DIR` makes one");
}

namespace {
fs::path temporary_for(const fs::path& file) { return fmt::format("{}.{}.new", file.string(), getpid()); }
}  // namespace

void SweepFolder::replace(const fs::path& file, const std::string& text) const {
  DurableFile(temporary_for(file), DurableFile::Open::Truncate).append(text);
  fs::rename(temporary_for(file), file);
}

void SweepFolder::write_atomically(const fs::path& file, const std::string& text) const {
  const fs::path temporary = temporary_for(file);
  {
    DurableFile out(temporary, DurableFile::Open::Truncate);
    out.append(text);
    out.sync();
  }
  fs::rename(temporary, file);
  sync_folder(file.parent_path());
}

void SweepFolder::write_points(const std::vector<Point>& points) const {
  std::string text;
  for (const Point& point : points) text += to_line(point) + "\n";
  replace(points_file(), text);
}

std::vector<Point> SweepFolder::read_points() const {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;
  if (!fs::exists(points_file()))
    throw Error(path_.string(), "nothing was run here", "`ctusim sweep run SPACE.toml -o DIR` plans and runs");
  std::istringstream in(read_file(points_file(), kMostBytes, "run the sweep again, which plans it anew"));
  std::vector<Point> points;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number)
    points.push_back(point_from_line(line, fmt::format("{}:{}", points_file().string(), number)));
  return points;
}

FolderLock::FolderLock(const fs::path& file) : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0) throw Error(file.string(), std::strerror(errno), "check the folder and its permissions");
  // Points of a run that was killed a moment ago hold its lock until they are gone as well.
  constexpr int kTries = 20;
  constexpr auto kPause = std::chrono::milliseconds(50);
  int tries = 0;
  while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (++tries < kTries) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    char holder[64] = {};
    if (::pread(descriptor_, holder, sizeof holder - 1, 0) <= 0) std::strcpy(holder, "unknown");
    ::close(descriptor_);
    throw Error(file.string(), fmt::format("another sweep works here (process {})", holder),
                "wait for it or end it; its results stay");
  }
  const std::string self = fmt::format("{}\n", getpid());
  [[maybe_unused]] const int cut = ::ftruncate(descriptor_, 0);
  [[maybe_unused]] const ssize_t written = ::pwrite(descriptor_, self.data(), self.size() - 1, 0);
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace ctu::sweep
