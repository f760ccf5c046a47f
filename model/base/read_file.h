// A file as one string, read only where it is a file and not beyond a limit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ctu {

/// Throws Error when the path is a folder, a pipe or a device (which may never end), cannot be opened or read, or holds
/// more than `most_bytes`; `remedy` is what to do then.
std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes, const std::string& remedy);

/// A number of bytes as people write it: "8 GiB", "640 bytes".
std::string bytes_text(std::uint64_t bytes);

}  // namespace ctu
