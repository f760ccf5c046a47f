#include "model/scene/source_file.h"

#include <fmt/core.h>
#include <zstd.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <memory>

#include "model/base/error.h"

namespace ctu::scene {
namespace {

constexpr std::uint64_t kLargestFileBytes = std::uint64_t{8} << 30;

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed))
    throw Error(path.string(), "is a folder", "name the scene file in it");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw Error(path.string(), "cannot be opened", "check the name, and that you may read it");
  const auto bytes = static_cast<std::uint64_t>(in.tellg());
  if (bytes > kLargestFileBytes) throw Error(path.string(), "is larger than 8 GiB", "split the scene");
  std::string content(bytes, '\0');
  in.seekg(0);
  if (!in.read(content.data(), static_cast<std::streamsize>(bytes)))
    throw Error(path.string(), "could not be read to its end", "check the disk");
  return content;
}

// Expands piece by piece: the size that a frame header claims is never trusted.
std::string expand(const std::string& packed, const std::string& path) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  std::string content;
  std::string piece(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t wanted = packed.empty() ? 1 : 0;
  while (in.pos < in.size || wanted != 0) {
    ZSTD_outBuffer out{piece.data(), piece.size(), 0};
    const std::size_t before = in.pos;
    wanted = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(wanted))
      throw Error(fmt::format("{}: byte {}", path, before),
                  fmt::format("is damaged as zstd: {}", ZSTD_getErrorName(wanted)), "fetch or compress the file again");
    content.append(piece.data(), out.pos);
    if (content.size() > kLargestFileBytes) throw Error(path, "expands to more than 8 GiB", "split the scene");
    if (wanted != 0 && in.pos == in.size && out.pos < out.size)
      throw Error(fmt::format("{}: byte {}", path, in.pos), "ends inside a zstd frame",
                  "the file is cut off: fetch or compress it again");
  }
  return content;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_compressed(const std::filesystem::path& path) { return lower(path.extension().string()) == ".zst"; }

}  // namespace

SourceFile read_source(const std::filesystem::path& path) {
  SourceFile file{path.string(), path.parent_path(), read_bytes(path)};
  if (is_compressed(path)) file.bytes = expand(file.bytes, file.path);
  return file;
}

std::string extension_of(const std::filesystem::path& path) {
  const auto inner = is_compressed(path) ? path.stem() : path;
  const std::string dotted = lower(inner.extension().string());
  return dotted.empty() ? dotted : dotted.substr(1);
}

std::string stem_of(const std::filesystem::path& path) {
  const auto inner = is_compressed(path) ? path.stem() : path.filename();
  return inner.stem().string();
}

}  // namespace ctu::scene
