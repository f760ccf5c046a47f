#include "tests/fuzz/trace_inputs.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <vector>

#include "model/base/hash.h"
#include "model/pipeline/engine.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/fuzz/input_folder.h"
#include "tests/traces/parts.h"
#include "traces/mask_set.h"
#include "traces/slice.h"
#include "traces/trace_feed.h"
#include "traces/trace_reader.h"

namespace ctu::fuzz {
namespace {

using cull::Design;
using traces::IndexEntry;
using traces::test::Bytes;
using traces::test::Parts;

const InputFolder& folder() {
  static const InputFolder files;
  return files;
}

/// The unit over a range of the trace, replaying and computing. A valid trace runs to its end.
void run_unit(const traces::TraceReader& reader, const accel::Bvh4& bvh, const cull::ObjectMasks& masks,
              const cull::MaskTester& tester, const accel::Image& image) {
  pipeline::UnitConfig config;
  config.mask_test.design = tester.design();
  for (const bool exec : {false, true}) {
    traces::TraceFeed feed =
        exec ? traces::TraceFeed(reader, {0, 20}) : traces::TraceFeed(reader, {0, 20}, bvh, &masks, tester);
    pipeline::EngineOptions options;
    options.exec = exec;
    const auto engine = pipeline::make_engine(config, {image, tester, feed}, options);
    const pipeline::UnitResult result = pipeline::run_to_end(*engine);
    require(result.rays == std::min<std::uint64_t>(20, reader.rays()), "every ray is returned");
  }
}

/// Everything that the program does with a trace.
void use_trace(const std::string& path) {
  const traces::TraceReader reader(path);
  reader.verify();
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::MaskOptions& options = reader.manifest().masks;
  traces::MaskSet set;
  set.lut = reader.compression();
  set.masks = traces::masks_of(image, options, set.lut.get());
  traces::test::read_all(path);
  for (const Design design : {Design::None, Design::Comparators}) {
    if (design != Design::None && set.masks.bits.empty()) continue;
    const cull::MaskTester tester(design, options, set.lut);
    const accel::Image fetched = traces::image_of(bvh, design == Design::None ? nullptr : &set, image.layout);
    accepts([&] { run_unit(reader, bvh, set.masks, tester, fetched); });
  }
  const std::string part = folder().path("part.ctut");
  traces::slice(path, part, {reader.rays() / 3, reader.rays() / 3 + 5});
  traces::test::read_all(part);
}

// --- a file of any bytes ------------------------------------------------------------------------------------------

template <class T>
bool take(const Bytes& bytes, std::uint64_t offset, T& to) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return false;
  std::memcpy(&to, bytes.data() + offset, sizeof(T));
  return true;
}

bool holds(const Bytes& bytes, std::uint64_t offset, std::uint64_t count) {
  return offset <= bytes.size() && count <= bytes.size() - offset;
}

std::uint64_t plane_checksum(const std::uint8_t* planes, std::uint64_t elements, std::size_t width) {
  Bytes values(elements * width);
  for (std::uint64_t i = 0; i < elements; ++i)
    for (std::size_t b = 0; b < width; ++b) values[i * width + b] = planes[b * elements + i];
  return hash64(values.data(), values.size());
}

/// The checksum of a column is that of its elements, whose width only the manifest says: the widths that divide the
/// frame's content are tried in the order of their number in a trace.
void mend_entry(const Bytes& bytes, IndexEntry& entry) {
  constexpr std::uint64_t kMostBytes = 1u << 22;
  if (!holds(bytes, entry.offset, entry.stored_bytes) || entry.elements == 0) return;
  const auto* frame = bytes.data() + entry.offset;
  const unsigned long long size = ZSTD_getFrameContentSize(frame, entry.stored_bytes);
  if (size > kMostBytes || size % entry.elements != 0) return;
  Bytes planes(size);
  const std::size_t got = ZSTD_decompress(planes.data(), planes.size(), frame, entry.stored_bytes);
  if (ZSTD_isError(got) == 0 && got == size)
    entry.checksum = plane_checksum(planes.data(), entry.elements, size / entry.elements);
}

/// Makes every checksum right that can be found.
void mend(Bytes& bytes) {
  traces::FileFooter footer;
  if (bytes.size() < sizeof footer) return;
  const std::uint64_t footer_place = bytes.size() - sizeof footer;
  take(bytes, footer_place, footer);
  std::vector<IndexEntry> index;
  const std::uint64_t index_place = footer.index_offset + traces::kSkippableHeaderBytes;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(footer.index_entries, bytes.size() / sizeof(IndexEntry)); ++i) {
    IndexEntry entry;
    if (!take(bytes, index_place + i * sizeof entry, entry)) break;
    mend_entry(bytes, entry);
    std::memcpy(bytes.data() + index_place + i * sizeof entry, &entry, sizeof entry);
    index.push_back(entry);
  }
  footer.index_checksum = hash64(index.data(), index.size() * sizeof(IndexEntry));
  const std::uint64_t manifest_place = footer.manifest_offset + traces::kSkippableHeaderBytes;
  if (holds(bytes, manifest_place, footer.manifest_bytes))
    footer.manifest_checksum = hash64(bytes.data() + manifest_place, footer.manifest_bytes);
  footer.checksum = hash64(&footer, offsetof(traces::FileFooter, checksum));
  std::memcpy(bytes.data() + footer_place, &footer, sizeof footer);
  traces::FileHeader header;
  if (!take(bytes, 0, header)) return;
  header.checksum = hash64(&header, offsetof(traces::FileHeader, checksum));
  std::memcpy(bytes.data(), &header, sizeof header);
}

// --- changes ------------------------------------------------------------------------------------------------------

std::string record_base(int number) {
  const std::string path = folder().path("base" + std::to_string(number) + ".ctut");
  traces::RecordOptions options;
  options.rays.kind = number == 0 ? traces::RayOptions::Rays::Diffuse : traces::RayOptions::Rays::Shadow;
  options.rays.width = options.rays.height = 4;
  options.rays.bounces = 2;
  options.rays_per_block = 12;
  options.masks.resolution = options.masks.ray_resolution = number == 2 ? 3 : 2;
  options.masks.entries = number == 1 ? cull::kMinEntries : 0;
  options.with_masks = number != 3;
  options.strip_full = number == 1;
  options.layout.box_bits = number == 4 ? 12 : accel::kFullBoxBits;
  if (!options.with_masks) options.designs = {Design::None};
  traces::record(scene::load(number == 2 ? "gen:tilted-quads?quads=20&size=0.6" : "gen:hair-ball?strands=6&segments=3"),
                 options, path);
  return path;
}

const Parts& base(std::size_t number) {
  static const std::array<Parts, 5> parts = {Parts(record_base(0)), Parts(record_base(1)), Parts(record_base(2)),
                                             Parts(record_base(3)), Parts(record_base(4))};
  return parts[number % parts.size()];
}

struct Change {
  std::uint8_t kind = 0, which = 0;
  std::uint16_t place = 0;
  std::uint32_t value = 0;
};
static_assert(sizeof(Change) == 8);

/// Throws Error when the index was changed and gives no element of a column.
std::size_t width_of(const Parts::Chunk& chunk) {
  const unsigned long long bytes = ZSTD_getFrameContentSize(chunk.frame.data(), chunk.frame.size());
  if (chunk.entry.elements == 0) return 1;
  const unsigned long long width = bytes / chunk.entry.elements;
  if (width * chunk.entry.elements != bytes || width == 0 || width > 8 || !std::has_single_bit(width))
    throw Error("index", "does not describe its column", "");
  return static_cast<std::size_t>(width);
}

/// The column's bytes, element after element, given to `edit`; `edit` may change their number.
template <class T, class Edit>
void edit_elements(Parts::Chunk& chunk, Edit&& edit) {
  std::vector<T> values = Parts::elements<T>(chunk);
  edit(values);
  Parts::set_elements(chunk, values);
}

template <class Edit>
void edit_column(Parts::Chunk& chunk, Edit&& edit) {
  switch (width_of(chunk)) {
    case 1:
      return edit_elements<std::uint8_t>(chunk, edit);
    case 2:
      return edit_elements<std::uint16_t>(chunk, edit);
    case 4:
      return edit_elements<std::uint32_t>(chunk, edit);
    default:
      return edit_elements<std::uint64_t>(chunk, edit);
  }
}

/// Replaces the place-th number or quoted word of the manifest.
void change_word(std::string& manifest, bool number, std::size_t place, const std::string& to) {
  std::vector<std::pair<std::size_t, std::size_t>> words;  // first, bytes
  for (std::size_t i = 0; i < manifest.size();) {
    if (manifest[i] == '"') {
      const std::size_t end = std::min(manifest.find('"', i + 1), manifest.size() - 1);
      if (!number) words.emplace_back(i, end + 1 - i);
      i = end + 1;
    } else if (std::isdigit(static_cast<unsigned char>(manifest[i])) != 0 || manifest[i] == '-') {
      const std::size_t end = std::min(manifest.find_first_not_of("0123456789+-.eE", i), manifest.size());
      if (number) words.emplace_back(i, end - i);
      i = end;
    } else {
      ++i;
    }
  }
  if (words.empty()) return;
  const auto [first, bytes] = words[place % words.size()];
  manifest.replace(first, bytes, to);
}

std::string number_of(std::uint32_t value) {
  static constexpr const char* kSpecial[] = {"0",
                                             "1",
                                             "-1",
                                             "255",
                                             "256",
                                             "65536",
                                             "2147483647",
                                             "2147483648",
                                             "4294967295",
                                             "4294967296",
                                             "9223372036854775808",
                                             "18446744073709551615",
                                             "1e39",
                                             "1e999",
                                             "0.5",
                                             "null",
                                             "\"text\"",
                                             "{}",
                                             "[]",
                                             "true"};
  constexpr std::uint32_t kSpecials = std::size(kSpecial);
  return value % 3 == 0 ? kSpecial[value / 3 % kSpecials] : std::to_string(value >> (value % 32));
}

std::string word_of(std::uint32_t value) {
  static constexpr const char* kWords[] = {"none",       "mask-lut",   "comparators", "steps.none", "image", "rays",
                                           "hits",       "u8",         "u16",         "u32",        "u64",   "f32",
                                           "ray",        "step",       "key",         "word",       "",      "kind",
                                           "0x7f800000", "0xffffffff", "top-summed",  "refined",    "random"};
  std::string quoted(1, '"');
  quoted += kWords[value % std::size(kWords)];
  return quoted += '"';
}

void change_index(Parts& parts, const Change& change) {
  Parts::Chunk& chunk = parts.chunks[change.which % parts.chunks.size()];
  switch (change.place % 6) {
    case 0:
      chunk.entry.section = static_cast<std::uint16_t>(change.value);
      return;
    case 1:
      chunk.entry.column = static_cast<std::uint16_t>(change.value);
      return;
    case 2:
      chunk.entry.block = change.value;
      return;
    case 3:
      chunk.entry.elements = change.value;
      return;
    case 4:
      parts.chunks.push_back(chunk);
      return;
    default:
      std::swap(chunk, parts.chunks[change.value % parts.chunks.size()]);
  }
}

void apply(Parts& parts, const Change& change) {
  constexpr std::uint32_t kMostElements = 4096;
  if (parts.chunks.empty()) return;
  Parts::Chunk& chunk = parts.chunks[change.which % parts.chunks.size()];
  const auto at = [&](auto& values) -> auto& { return values[change.place % values.size()]; };
  switch (change.kind % 8) {
    case 0:
    case 1:
      return edit_column(chunk, [&](auto& values) {
        if (!values.empty()) at(values) = static_cast<std::decay_t<decltype(values[0])>>(change.value);
      });
    case 2:
      return edit_column(chunk, [&](auto& values) {
        if (!values.empty()) at(values) ^= static_cast<std::decay_t<decltype(values[0])>>(1u << (change.value % 32));
      });
    case 3:
      return edit_column(chunk, [&](auto& values) { values.resize(change.value % kMostElements); });
    case 4:
      return change_word(parts.manifest, true, change.place, number_of(change.value));
    case 5:
      return change_word(parts.manifest, false, change.place, word_of(change.value));
    case 6:
      parts.chunks.erase(parts.chunks.begin() + static_cast<std::ptrdiff_t>(change.which % parts.chunks.size()));
      return;
    default:
      return change_index(parts, change);
  }
}

}  // namespace

void read_trace_file(Input input) {
  Bytes bytes(input.begin(), input.end());
  mend(bytes);
  const std::string path = folder().put("file.ctut", Input(bytes));
  accepts([&] { use_trace(path); });
}

void read_changed_trace(Input input) {
  if (input.empty()) return;
  Parts parts = base(input[0]);
  for (std::size_t place = 1; place + sizeof(Change) <= input.size(); place += sizeof(Change)) {
    Change change;
    std::memcpy(&change, input.data() + place, sizeof change);
    try {
      apply(parts, change);
    } catch (const Error&) {
      break;  // an index that describes its column no longer: it cannot be changed further
    }
  }
  const std::string path = folder().path("changed.ctut");
  parts.write(path);
  accepts([&] { use_trace(path); });
}

void read_manifest(Input input) {
  accepts([&] {
    const traces::Manifest manifest = traces::manifest_from_json(std::string(as_text(input)), "manifest");
    traces::manifest_from_json(traces::to_json(manifest), "manifest");
  });
}

}  // namespace ctu::fuzz
