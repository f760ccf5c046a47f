#include "traces/columns.h"

#include <cstring>
#include <type_traits>

#include <fmt/format.h>
#include <zstd.h>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "traces/file.h"

namespace ctu::traces {
namespace {

constexpr int kZstdLevel = 1;
// A zstd block yields at most 128 KiB and takes at least 4 bytes, so no honest frame grows more than this.
constexpr std::uint64_t kMaxGrowth = 1u << 15;

// Whole words in, shifts out: loops of this shape become vector instructions.
template <class Word>
void spread(const std::uint8_t* __restrict from, std::size_t elements, std::uint8_t* __restrict to) {
  for (std::size_t b = 0; b < sizeof(Word); ++b)
    for (std::size_t i = 0; i < elements; ++i) {
      Word word;
      std::memcpy(&word, from + i * sizeof word, sizeof word);
      to[b * elements + i] = static_cast<std::uint8_t>(word >> (8 * b));
    }
}

template <class Word>
void gather(const std::uint8_t* __restrict from, std::size_t elements, std::uint8_t* __restrict to) {
  for (std::size_t i = 0; i < elements; ++i) {
    std::common_type_t<Word, std::uint32_t> word = 0;  // shifts of narrower ones would be signed
    for (std::size_t b = 0; b < sizeof(Word); ++b) word |= decltype(word){from[b * elements + i]} << (8 * b);
    const auto value = static_cast<Word>(word);
    std::memcpy(to + i * sizeof value, &value, sizeof value);
  }
}

[[noreturn]] void damaged(const std::string& path, const std::string& what, const std::string& problem) {
  throw Error(path, fmt::format("{}: {}", what, problem),
              "record the trace again, or copy it again from where it came");
}

}  // namespace

std::string to_string(Per per) {
  static constexpr const char* kNames[] = {"ray", "step", "key", "leaf", "word", "packet", "visit", "entry", ""};
  return kNames[static_cast<int>(per)];
}

std::size_t type_bytes(const std::string& type) {
  if (type == "u64") return 8;
  if (type == "f32" || type == "u32") return 4;
  if (type == "u16") return 2;
  if (type == "u8") return 1;
  return 0;
}

Section image_section() {
  return {"image", {{"words", "u32", Per::Word, "4 bytes", "the bytes the unit fetches, four by four"}}};
}

Section rays_section(bool with_trees) {
  Section section{"rays",
                  {{"origin_x", "f32", Per::Ray, "scene units", "origin"},
                   {"origin_y", "f32", Per::Ray, "scene units", "origin"},
                   {"origin_z", "f32", Per::Ray, "scene units", "origin"},
                   {"tmin", "f32", Per::Ray, "direction lengths", "first point of the ray"},
                   {"direction_x", "f32", Per::Ray, "scene units", "direction, of any length"},
                   {"direction_y", "f32", Per::Ray, "scene units", "direction, of any length"},
                   {"direction_z", "f32", Per::Ray, "scene units", "direction, of any length"},
                   {"tmax", "f32", Per::Ray, "direction lengths", "last point of the ray; may be infinite"},
                   {"kind", "u8", Per::Ray, "", "0: closest hit, 1: any hit"}}};
  if (with_trees) {
    section.columns.push_back({"tree", "u8", Per::Ray, "", "that the ray walks; 0 is over the whole scene"});
    section.columns.push_back({"own_tests", "u32", Per::Ray, "tests", "of boxes and primitives there, unculled"});
    section.columns.push_back(
        {"global_tests", "u32", Per::Ray, "tests", "of boxes and primitives in tree 0, unculled"});
  }
  return section;
}

Section hits_section() {
  return {"hits",
          {{"t", "f32", Per::Ray, "direction lengths", "of the hit without culling; tmax when there is none"},
           {"u", "f32", Per::Ray, "", "barycentric coordinate of the second corner"},
           {"v", "f32", Per::Ray, "", "barycentric coordinate of the third corner"},
           {"primitive", "u32", Per::Ray, "", "triangle's id in the scene; 4294967295: no hit"}}};
}

Section steps_section(const std::string& design, const StepColumns& has) {
  Section section{"steps." + design,
                  {{"steps", "u32", Per::Ray, "steps", "visits of the ray"},
                   {"tail_dropped", "u8", Per::Ray, "entries", "stack entries dropped after the last visit"},
                   {"ref", "u32", Per::Step, "", "node or leaf, as in the image's child references"},
                   {"dropped", "u8", Per::Step, "entries", "stack entries dropped before this visit"},
                   {"lanes", "u8", Per::Step, "", "node: box hits | survivors << 4; leaf: triangles tested"},
                   {"detail", "u16", Per::Step, "", "node: visiting order | uncertain << 8; leaf: new best hits"}}};
  if (has.keys)
    section.columns.push_back({"key", "u32", Per::Key, "", "begin and end cells of each lane the box test hit"});
  if (has.met)
    section.columns.push_back({"met", "u16", Per::Leaf, "", "primitives whose boxes the ray's box meets, bit by bit"});
  if (has.spared)
    section.columns.push_back(
        {"spared", "u16", Per::Ray, "nodes", "above the packet's entries; visited by the ray alone"});
  return section;
}

Section packets_section() {
  return {"packets",
          {{"rays", "u8", Per::Packet, "rays", "consecutive rays of the packet"},
           {"visits", "u16", Per::Packet, "nodes", "nodes that the packet was asked about"},
           {"entries", "u8", Per::Packet, "nodes", "places where its rays go on alone"},
           {"node", "u32", Per::Visit, "", "node, as in the image's child references"},
           {"lanes", "u8", Per::Visit, "", "children that some ray may meet | that every ray meets << 4"},
           {"entry", "u32", Per::Entry, "", "node, nearest first"}}};
}

Section compression_section() {
  return {
      "compression",
      {{"entries", "u64", Per::Word, "64 cells", "masks that indices name: fewest cells first, the last one full"}}};
}

struct ColumnEncoder::State {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  std::vector<std::uint8_t> planes;
  ~State() { ZSTD_freeCCtx(context); }
};

ColumnEncoder::ColumnEncoder() : state_(std::make_unique<State>()) {
  if (state_->context == nullptr) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(state_->context, ZSTD_c_compressionLevel, kZstdLevel);
  ZSTD_CCtx_setParameter(state_->context, ZSTD_c_checksumFlag, 1);  // lets `zstd -t` check the file
}
ColumnEncoder::~ColumnEncoder() = default;
ColumnEncoder::ColumnEncoder(ColumnEncoder&&) noexcept = default;

EncodedColumn ColumnEncoder::encode(const void* data, std::size_t elements, std::size_t width) {
  const std::size_t bytes = elements * width;
  if (bytes > kMaxColumnBytes)
    throw Error("trace", "one block of rays takes more than 1 GiB", "record with fewer rays per block");
  EncodedColumn out;
  out.elements = static_cast<std::uint32_t>(elements);
  out.checksum = hash64(data, bytes);
  const auto* source = static_cast<const std::uint8_t*>(data);
  const std::uint8_t* planes = source;
  if (width > 1) {
    state_->planes.resize(bytes);
    if (width == 8) spread<std::uint64_t>(source, elements, state_->planes.data());
    if (width == 4) spread<std::uint32_t>(source, elements, state_->planes.data());
    if (width == 2) spread<std::uint16_t>(source, elements, state_->planes.data());
    planes = state_->planes.data();
  }
  out.frame.resize(ZSTD_compressBound(bytes));
  const std::size_t stored = ZSTD_compress2(state_->context, out.frame.data(), out.frame.size(), planes, bytes);
  if (ZSTD_isError(stored) != 0)
    throw Error("trace", fmt::format("compression failed: {}", ZSTD_getErrorName(stored)), "");
  out.frame.resize(stored);
  out.frame.shrink_to_fit();
  return out;
}

struct ColumnDecoder::State {
  ZSTD_DCtx* context = ZSTD_createDCtx();
  std::vector<std::uint8_t> planes;
  ~State() { ZSTD_freeDCtx(context); }
};

ColumnDecoder::ColumnDecoder() : state_(std::make_unique<State>()) {
  if (state_->context == nullptr) throw std::bad_alloc();
}
ColumnDecoder::~ColumnDecoder() = default;

void ColumnDecoder::check_size(const std::vector<std::uint8_t>& frame, std::uint64_t elements, std::size_t width,
                               const std::string& path, const std::string& what) {
  const std::uint64_t bytes = elements * width;  // both below 2^32
  if (bytes > kMaxColumnBytes || bytes > frame.size() * kMaxGrowth)
    damaged(path, what, fmt::format("{} elements are more than its {} stored bytes can hold", elements, frame.size()));
  if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != bytes ||
      ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size())
    damaged(path, what, "damaged: the compressed frame does not have the size that the index gives");
}

void ColumnDecoder::decode(const std::vector<std::uint8_t>& frame, std::size_t elements, std::size_t width,
                           std::uint64_t checksum, void* to, const std::string& path, const std::string& what) {
  check_size(frame, elements, width, path, what);
  const std::size_t bytes = elements * width;
  auto* out = static_cast<std::uint8_t*>(to);
  std::uint8_t* planes = out;
  if (width > 1) {
    state_->planes.resize(bytes);
    planes = state_->planes.data();
  }
  const std::size_t got = ZSTD_decompressDCtx(state_->context, planes, bytes, frame.data(), frame.size());
  if (ZSTD_isError(got) != 0) damaged(path, what, fmt::format("damaged: {}", ZSTD_getErrorName(got)));
  if (got != bytes) damaged(path, what, "damaged: the compressed frame holds another size");
  if (width == 8) gather<std::uint64_t>(planes, elements, out);
  if (width == 4) gather<std::uint32_t>(planes, elements, out);
  if (width == 2) gather<std::uint16_t>(planes, elements, out);
  if (hash64(out, bytes) != checksum) damaged(path, what, "damaged: its checksum does not match");
}

}  // namespace ctu::traces
