// A file that lines are appended to so that each is there as a whole, once append and sync have returned.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace ctu::sweep {

class DurableFile {
 public:
  enum class Open { Append, Truncate };
  DurableFile(const std::filesystem::path& path, Open how);
  ~DurableFile();
  DurableFile(const DurableFile&) = delete;
  DurableFile& operator=(const DurableFile&) = delete;

  /// In one write. Throws Error when the disk does not take it; what it took of it is cut off again.
  void append(std::string_view text);
  void sync();
  int descriptor() const { return descriptor_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// What the file holds is on the disk.
void sync_file(const std::filesystem::path& path);

/// Names of files in it are on the disk as well.
void sync_folder(const std::filesystem::path& folder);

/// Cuts off what stands behind the last end of a line: a write that did not come to its end. How many bytes that were.
std::uint64_t cut_torn_line(const std::filesystem::path& path);

}  // namespace ctu::sweep
