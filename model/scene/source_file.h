// A scene file in memory. A file compressed with zstd (its name ends in .zst) is read as what it holds.
#pragma once

#include <filesystem>
#include <string>

namespace ctu::scene {

struct SourceFile {
  std::string path;              ///< as the user gave it: what messages name
  std::filesystem::path folder;  ///< names inside the file are relative to this folder
  std::string bytes;             ///< uncompressed
};

/// Reads the whole file; `folder` becomes the file's own. Throws Error if it cannot be read, is no regular file, is
/// damaged as zstd, is larger than 8 GiB, or expands beyond that or (above 16 MiB) to more than a thousand times its
/// own size.
SourceFile read_source(const std::filesystem::path& path);

/// The lower-case extension that decides the format, without ".zst": "ply" for "Bunny.PLY.zst".
std::string extension_of(const std::filesystem::path& path);

/// The file name without its extension and without ".zst".
std::string stem_of(const std::filesystem::path& path);

}  // namespace ctu::scene
