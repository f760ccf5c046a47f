#include "sim/timeline/timeline_file.h"

#include <fstream>

#include <fmt/format.h>
#include <zstd.h>

#include "model/base/error.h"
#include "sim/timeline/kanata_log.h"
#include "sim/timeline/perfetto_trace.h"

namespace ctu::sim {
namespace {

constexpr int kZstdLevel = 3;

std::string packed(const std::string& text) {
  std::string bytes(ZSTD_compressBound(text.size()), '\0');
  const std::size_t size = ZSTD_compress(bytes.data(), bytes.size(), text.data(), text.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  bytes.resize(size);
  return bytes;
}

}  // namespace

void check_timeline_name(const std::string& path) {
  for (const char* known : {".kanata", ".kanata.zst", ".pftrace"})
    if (path.ends_with(known)) return;
  throw Error(path, "no kind of timeline has this name",
              "end it in .kanata or .kanata.zst for Konata, or in .pftrace for Perfetto");
}

void write_timeline(const pipeline::Timeline& timeline, const std::string& path) {
  if (timeline.run_cycles() <= timeline.first())
    throw Error("--window", fmt::format("the run was over after {} cycles", timeline.run_cycles()),
                "give a window that begins before that");
  std::string bytes;
  if (path.ends_with(".pftrace"))
    bytes = perfetto_trace(timeline);
  else if (path.ends_with(".zst"))
    bytes = packed(kanata_log(timeline));
  else
    bytes = kanata_log(timeline);
  std::ofstream out(path, std::ios::binary);
  out << bytes;
  if (!out.flush()) throw Error(path, "the timeline could not be written", "check the folder and the free space");
}

}  // namespace ctu::sim
