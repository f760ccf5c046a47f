#include "model/base/read_file.h"

#include <fmt/core.h>

#include <fstream>

#include "model/base/error.h"

namespace ctu {

std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes, const std::string& remedy) {
  std::error_code unreadable;
  const std::filesystem::file_status status = std::filesystem::status(path, unreadable);
  if (std::filesystem::is_directory(status)) throw Error(path.string(), "is a folder", "name a file in it");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw Error(path.string(), "is a pipe or a device", "name a file");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw Error(path.string(), "cannot be opened", "check the name, and that you may read it");
  const auto bytes = static_cast<std::uint64_t>(in.tellg());
  if (bytes > most_bytes) throw Error(path.string(), "is larger than " + bytes_text(most_bytes), remedy);
  std::string content(bytes, '\0');
  in.seekg(0);
  if (!in.read(content.data(), static_cast<std::streamsize>(bytes)))
    throw Error(path.string(), "could not be read to its end", "check the disk");
  return content;
}

std::string bytes_text(std::uint64_t bytes) {
  static constexpr const char* kUnits[] = {"bytes", "KiB", "MiB", "GiB"};
  std::size_t unit = 0;
  for (; unit + 1 < std::size(kUnits) && bytes != 0 && bytes % 1024 == 0; ++unit) bytes /= 1024;
  return fmt::format("{} {}", bytes, kUnits[unit]);
}

}  // namespace ctu
