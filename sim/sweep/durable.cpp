#include "sim/sweep/durable.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "model/base/error.h"

namespace ctu::sweep {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw Error(path.string(), std::strerror(errno), "check the folder, its permissions and the space on the disk");
}

/// Closed whatever happens.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

DurableFile::DurableFile(const std::filesystem::path& path, Open how)
    : path_(path),
      descriptor_(
          ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (how == Open::Append ? O_APPEND : O_TRUNC), 0644)) {
  if (descriptor_ < 0) refuse(path_);
}

DurableFile::~DurableFile() { ::close(descriptor_); }

void DurableFile::append(std::string_view text) {
  struct stat before {};
  if (::fstat(descriptor_, &before) != 0) refuse(path_);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_, before.st_size);
      errno = reason;
      refuse(path_);
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void DurableFile::sync() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) refuse(path_);
}

void sync_file(const std::filesystem::path& path) {
  const Descriptor open{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (open.number < 0 || ::fsync(open.number) != 0) refuse(path);
}

void sync_folder(const std::filesystem::path& folder) {
  const Descriptor open{::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (open.number >= 0) ::fsync(open.number);
}

std::uint64_t cut_torn_line(const std::filesystem::path& path) {
  const Descriptor open{::open(path.c_str(), O_RDWR | O_CLOEXEC)};
  if (open.number < 0) {
    if (errno == ENOENT) return 0;
    refuse(path);
  }
  struct stat status {};
  if (::fstat(open.number, &status) != 0) refuse(path);
  off_t whole = status.st_size;
  for (char buffer[4096]; whole > 0;) {
    const off_t first = std::max<off_t>(0, whole - static_cast<off_t>(sizeof buffer));
    const auto bytes = static_cast<std::size_t>(whole - first);
    if (::pread(open.number, buffer, bytes, first) != static_cast<ssize_t>(bytes)) refuse(path);
    const auto* end = static_cast<const char*>(memrchr(buffer, '\n', bytes));
    if (end != nullptr) {
      whole = first + (end - buffer) + 1;
      break;
    }
    whole = first;
  }
  if (whole != status.st_size && (::ftruncate(open.number, whole) != 0 || ::fsync(open.number) != 0)) refuse(path);
  return static_cast<std::uint64_t>(status.st_size - whole);
}

}  // namespace ctu::sweep
