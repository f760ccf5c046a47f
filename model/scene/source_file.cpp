#include "model/scene/source_file.h"

#include <fmt/core.h>
#include <zstd.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>

#include "model/base/error.h"
#include "model/base/read_file.h"

namespace ctu::scene {
namespace {

constexpr std::uint64_t kLargestFileBytes = std::uint64_t{8} << 30;

// What a scene is packed by is 3 to 30; a frame of one repeated byte can reach thirty thousand.
constexpr std::uint64_t kMostGrowth = 1000, kAlwaysExpandedBytes = std::uint64_t{16} << 20;

std::uint64_t most_expanded_bytes(std::uint64_t packed_bytes) {
  return std::min(kLargestFileBytes, std::max(kAlwaysExpandedBytes, packed_bytes * kMostGrowth));
}

// Expands piece by piece: the size that a frame header claims is never trusted.
std::string expand(const std::string& packed, const std::string& path) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  std::string content;
  std::string piece(ZSTD_DStreamOutSize(), '\0');
  const std::uint64_t most_bytes = most_expanded_bytes(packed.size());
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
    if (content.size() > most_bytes)
      throw Error(path, fmt::format("{} expand to more than {} bytes", bytes_text(packed.size()), most_bytes),
                  "no scene is packed so well: expand it by hand to see what it holds, or split the scene");
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
  SourceFile file{path.string(), path.parent_path(), read_file(path, kLargestFileBytes, "split the scene")};
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
