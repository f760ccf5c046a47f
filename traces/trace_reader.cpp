#include "traces/trace_reader.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/mask_words.h"
#include "traces/columns.h"
#include "traces/trace_hash.h"

namespace ctu::traces {
namespace {

using reference::StepList;

std::string steps_name(cull::Design design) {
  return "steps." + std::string(cull::to_string(cull::event_class(design)));
}

std::vector<std::uint8_t> read_frame(const InputFile& file, const IndexEntry& entry, const char* section) {
  std::vector<std::uint8_t> frame(entry.stored_bytes);  // lies within the file: read_layout checked
  file.read_at(entry.offset, frame.data(), frame.size(), section);
  return frame;
}

}  // namespace

TraceReader::TraceReader(const std::string& path) : file_(path) {
  FileLayout layout = read_layout(file_);
  index_ = std::move(layout.index);
  manifest_ = manifest_from_json(layout.manifest, path);
  index_columns();
  std::vector<Section> of_rays = {rays_section(manifest_.trees.any()), hits_section()};
  for (const DesignCounts& entry : manifest_.designs) {
    const bool keys = cull::event_class(entry.design) == cull::Design::MaskLut;
    if (entry.stored)
      of_rays.push_back(steps_section(std::string(cull::to_string(entry.design)),
                                      {keys, has_primitive_boxes(), manifest_.packets.any()}));
  }
  if (manifest_.packets.any()) of_rays.push_back(packets_section());
  expect_columns(image_section());
  for (const Section& wanted : of_rays) expect_columns(wanted);
  count_rays();
  for (const Section& wanted : of_rays) expect_rays(wanted);
  if (rays() != manifest_.ray_count) refuse("rays", "not as many rays as the manifest says");
  if (manifest_.masks.entries != 0) read_compression();
  hash_ = trace_hash(manifest_, index_);
}

void TraceReader::refuse(const std::string& section, const std::string& what) const {
  throw Error(path(), fmt::format("{}: {}", section, what),
              "record the trace again, or copy it again from where it came");
}

std::string TraceReader::describe(const IndexEntry& entry) const {
  const Section& section = manifest_.sections[entry.section];
  return fmt::format("{}.{} of block {}", section.name, section.columns[entry.column].name, entry.block);
}

void TraceReader::index_columns() {
  for (const Section& section : manifest_.sections) {
    auto& columns = places_.emplace_back(section.columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].width = type_bytes(section.columns[i].type);
  }
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const IndexEntry& entry = index_[i];
    if (entry.section >= places_.size() || entry.column >= places_[entry.section].size())
      refuse("index", fmt::format("entry {} is of a column that the manifest does not list", i));
    auto& entries = places_[entry.section][entry.column].entries;
    if (entry.block != entries.size()) refuse("index", fmt::format("blocks of {} are not in order", describe(entry)));
    entries.push_back(static_cast<std::uint32_t>(i));
  }
}

void TraceReader::expect_columns(const Section& wanted) const {
  const auto found = std::find_if(manifest_.sections.begin(), manifest_.sections.end(),
                                  [&](const Section& section) { return section.name == wanted.name; });
  if (found == manifest_.sections.end()) refuse(wanted.name, "the section is missing");
  for (const Column& column : wanted.columns) {
    const auto match = std::find_if(found->columns.begin(), found->columns.end(),
                                    [&](const Column& one) { return one.name == column.name; });
    if (match == found->columns.end() || match->type != column.type)
      refuse(wanted.name, fmt::format("column {} of type {} is missing", column.name, column.type));
  }
}

/// Only for columns that expect_columns() found.
const TraceReader::ColumnPlace& TraceReader::place(const std::string& section, const std::string& column) const {
  std::size_t s = 0, c = 0;
  while (manifest_.sections[s].name != section) ++s;
  while (manifest_.sections[s].columns[c].name != column) ++c;
  return places_[s][c];
}

/// The first ray column says where blocks begin.
void TraceReader::count_rays() {
  const Section rays = rays_section(manifest_.trees.any());
  for (const std::uint32_t entry : place(rays.name, rays.columns.front().name).entries) {
    const std::uint32_t count = index_[entry].elements;
    if (count == 0 || count > kMaxRaysPerBlock)
      refuse(rays.name, fmt::format("{} rays in one block; 1 to {} are possible", count, kMaxRaysPerBlock));
    first_ray_.push_back(first_ray_.back() + count);
  }
}

/// All columns have those blocks, and those with an element for each ray have as many.
void TraceReader::expect_rays(const Section& wanted) const {
  for (const Column& column : wanted.columns) {
    const std::vector<std::uint32_t>& entries = place(wanted.name, column.name).entries;
    if (entries.size() != blocks())
      refuse(wanted.name, fmt::format("column {} has {} blocks instead of {}", column.name, entries.size(), blocks()));
    if (column.per != Per::Ray) continue;
    for (std::uint64_t b = 0; b < blocks(); ++b)
      if (index_[entries[b]].elements != first_ray_[b + 1] - first_ray_[b])
        refuse(wanted.name, fmt::format("{} has another number of rays than the block", describe(index_[entries[b]])));
  }
}

std::uint64_t TraceReader::block_of(std::uint64_t ray) const {
  return static_cast<std::uint64_t>(std::upper_bound(first_ray_.begin(), first_ray_.end(), ray) - first_ray_.begin()) -
         1;
}

bool TraceReader::has_steps(cull::Design design) const {
  const DesignCounts* entry = manifest_.find(cull::event_class(design));
  return entry != nullptr && entry->stored;
}

template <class T>
std::vector<T> TraceReader::read_column(ColumnDecoder& decoder, const std::string& section, const char* column,
                                        std::uint64_t block, std::optional<std::uint64_t> elements) const {
  const IndexEntry& entry = index_[place(section, column).entries[block]];
  const std::string what = describe(entry);
  if (elements && entry.elements != *elements)
    refuse(what, fmt::format("{} elements instead of {}", entry.elements, *elements));
  const std::vector<std::uint8_t> frame = read_frame(file_, entry, section.c_str());
  ColumnDecoder::check_size(frame, entry.elements, sizeof(T), path(), what);
  std::vector<T> values(entry.elements);
  decoder.decode(frame, entry.elements, sizeof(T), entry.checksum, values.data(), path(), what);
  return values;
}

accel::Image TraceReader::read_image() const {
  const std::vector<std::uint32_t>& entries = place("image", "words").entries;
  std::uint64_t bytes = 0;
  for (const std::uint32_t entry : entries) bytes += std::uint64_t{index_[entry].elements} * sizeof(std::uint32_t);
  if (bytes != manifest_.image.size_bytes) refuse("image", "not as many bytes as the manifest says");
  accel::Image image = manifest_.image.shape;
  ColumnDecoder decoder;
  for (std::uint64_t block = 0; block < entries.size(); ++block) {
    const auto words = read_column<std::uint32_t>(decoder, "image", "words", block, std::nullopt);
    const auto* first = reinterpret_cast<const std::uint8_t*>(words.data());
    image.bytes.insert(image.bytes.end(), first, first + words.size() * sizeof(std::uint32_t));
  }
  try {
    accel::validate(image);
  } catch (const Error& problem) {
    refuse("image", problem.what());
  }
  check_masks(image);
  return image;
}

/// For an image that is valid but for what its masks mean.
void TraceReader::check_masks(const accel::Image& image) const {
  const std::uint32_t bits = image.layout.mask_bits;
  if (!compression_) {
    const auto resolution = static_cast<std::uint32_t>(manifest_.masks.resolution);
    if (bits != 0 && bits != resolution * resolution * resolution)
      refuse("image", fmt::format("masks of {} bits are not those of R = {}", bits, resolution));
    return;
  }
  if (bits != static_cast<std::uint32_t>(compression_->index_bits()))
    refuse("image",
           fmt::format("indices of {} bits into a compression LUT of {} entries", bits, compression_->entries()));
  const auto entries = static_cast<std::uint64_t>(compression_->entries());
  for (std::uint32_t node = 0; node < image.masked_nodes(); ++node)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      std::uint64_t index = 0;
      accel::read_mask(image, node, lane, &index);
      if (index >= entries)
        refuse("image", fmt::format("node {}, lane {}: there is no entry {} in the compression LUT of {}", node, lane,
                                    index, entries));
    }
}

/// The LUT is what its words say only if they are in the one order that it has.
void TraceReader::read_compression() {
  const Section section = compression_section();
  expect_columns(section);
  const std::string& column = section.columns.front().name;
  if (place(section.name, column).entries.size() != 1) refuse(section.name, "not one block");
  ColumnDecoder decoder;
  const auto words = read_column<std::uint64_t>(decoder, section.name, column.c_str(), 0, std::nullopt);
  const std::vector<std::uint64_t> full = cull::full_mask(manifest_.masks.resolution);
  const std::size_t size = full.size(), entries = words.size() / size;
  if (words.size() % size != 0 || entries < 1 || entries > static_cast<std::size_t>(manifest_.masks.entries))
    refuse(section.name,
           fmt::format("{} words are not up to {} entries of {}", words.size(), manifest_.masks.entries, size));
  for (std::size_t i = 0; i < entries; ++i)
    if (!cull::holds_all(full.data(), words.data() + i * size, static_cast<int>(size)))
      refuse(section.name, fmt::format("entry {} has cells that R = {} does not have", i, manifest_.masks.resolution));
  if (!std::equal(full.begin(), full.end(), words.end() - static_cast<std::ptrdiff_t>(size)))
    refuse(section.name, "the last entry is not the full mask");
  compression_ = std::make_shared<const cull::CompressionLut>(manifest_.masks.resolution, words);
  if (compression_->bits() != words) refuse(section.name, "the entries are not in ascending order, each once");
}

void TraceReader::read_rays(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const {
  static constexpr const char* kOrigin[] = {"origin_x", "origin_y", "origin_z"};
  static constexpr const char* kDirection[] = {"direction_x", "direction_y", "direction_z"};
  const std::uint64_t count = out.rays.size();
  const auto column = [&](const char* name) { return read_column<float>(decoder, "rays", name, block, count); };
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<float> origin = column(kOrigin[axis]), direction = column(kDirection[axis]);
    for (std::uint64_t i = 0; i < count; ++i) out.rays[i].origin[axis] = origin[i];
    for (std::uint64_t i = 0; i < count; ++i) out.rays[i].direction[axis] = direction[i];
  }
  const std::vector<float> tmin = column("tmin"), tmax = column("tmax");
  const auto kind = read_column<std::uint8_t>(decoder, "rays", "kind", block, count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (kind[i] > 1) refuse("rays", fmt::format("ray {} is of kind {}, which is none", out.first_ray + i, kind[i]));
    out.rays[i].tmin = tmin[i];
    out.rays[i].tmax = tmax[i];
    out.rays[i].kind = static_cast<intersect::RayKind>(kind[i]);
  }
}

void TraceReader::read_trees(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const {
  const std::uint64_t count = out.rays.size();
  const auto tree = read_column<std::uint8_t>(decoder, "rays", "tree", block, count);
  const auto own = read_column<std::uint32_t>(decoder, "rays", "own_tests", block, count);
  const auto global = read_column<std::uint32_t>(decoder, "rays", "global_tests", block, count);
  const std::uint32_t trees = manifest_.image.shape.trees();
  for (std::uint64_t i = 0; i < count; ++i) {
    if (tree[i] >= trees)
      refuse("rays", fmt::format("ray {} walks tree {}, and there are {}", out.first_ray + i, tree[i], trees));
    out.trees.push_back({tree[i], own[i], global[i]});
  }
}

void TraceReader::read_hits(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const {
  const std::uint64_t count = out.expected.size();
  const std::uint64_t primitives = manifest_.scene.triangles + manifest_.scene.spheres;
  const auto column = [&](const char* name) { return read_column<float>(decoder, "hits", name, block, count); };
  const std::vector<float> t = column("t"), u = column("u"), v = column("v");
  const auto primitive = read_column<std::uint32_t>(decoder, "hits", "primitive", block, count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (primitive[i] != intersect::kNoPrimitive && primitive[i] >= primitives)
      refuse("hits",
             fmt::format("ray {} hits primitive {}, which the scene does not have", out.first_ray + i, primitive[i]));
    out.expected[i] = {t[i], u[i], v[i], primitive[i]};
  }
}

void TraceReader::read_steps(ColumnDecoder& decoder, std::uint64_t block, cull::Design design,
                             reference::RayBlock& out) const {
  const std::string section = steps_name(design);
  if (!has_steps(design)) refuse(section, "the trace has no steps of this design");
  const std::uint64_t count = out.rays.size();
  StepList& list = out.steps;
  list.first_step.reserve(count + 1);
  for (const std::uint32_t steps : read_column<std::uint32_t>(decoder, section, "steps", block, count))
    list.first_step.push_back(list.first_step.back() + steps);
  list.tail_dropped = read_column<std::uint8_t>(decoder, section, "tail_dropped", block, count);
  const std::uint64_t total = list.first_step.back();
  const auto refs = read_column<std::uint32_t>(decoder, section, "ref", block, total);
  const auto dropped = read_column<std::uint8_t>(decoder, section, "dropped", block, total);
  const auto lanes = read_column<std::uint8_t>(decoder, section, "lanes", block, total);
  const auto detail = read_column<std::uint16_t>(decoder, section, "detail", block, total);
  list.steps.resize(total);
  for (std::uint64_t i = 0; i < total; ++i) list.steps[i] = {refs[i], dropped[i], lanes[i], detail[i]};

  if (manifest_.packets.any()) list.spared = read_column<std::uint16_t>(decoder, section, "spared", block, count);
  const bool keyed = cull::event_class(design) == cull::Design::MaskLut;
  list.first_key = list.first_met = std::vector<std::uint64_t>(count + 1, 0);
  // Where the elements of a ray begin, when each of its steps has `elements(step)` of them.
  const auto starts = [&](auto&& elements) {
    std::vector<std::uint64_t> first{0};
    first.reserve(count + 1);
    for (std::uint64_t ray = 0; ray < count; ++ray) {
      first.push_back(first.back());
      for (std::uint64_t i = list.first_step[ray]; i < list.first_step[ray + 1]; ++i)
        first.back() += static_cast<std::uint64_t>(elements(list.steps[i]));
    }
    return first;
  };
  if (keyed) {
    list.first_key = starts([](const auto& step) { return step.is_leaf() ? 0 : std::popcount(step.box_hits()); });
    list.keys = read_column<std::uint32_t>(decoder, section, "key", block, list.first_key.back());
  }
  if (has_primitive_boxes()) {
    list.first_met = starts([](const auto& step) { return step.is_leaf(); });
    list.met = read_column<std::uint16_t>(decoder, section, "met", block, list.first_met.back());
  }
}

void TraceReader::read_packets(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const {
  const std::string section = packets_section().name;
  reference::PacketList& list = out.packets;
  const auto rays = read_column<std::uint8_t>(decoder, section, "rays", block, std::nullopt);
  const auto packets = static_cast<std::uint64_t>(rays.size());
  for (const std::uint8_t count : rays) {
    if (count == 0 || count > manifest_.packets.plan.size)
      refuse(section,
             fmt::format("a packet of {} rays, where 1 to {} are possible", count, manifest_.packets.plan.size));
    list.first_ray.push_back(list.first_ray.back() + count);
  }
  if (list.first_ray.back() != out.rays.size())
    refuse(section, fmt::format("packets of {} rays in a block of {}", list.first_ray.back(), out.rays.size()));
  for (std::uint64_t packet = 0; packet < packets; ++packet)
    for (std::uint64_t ray = list.first_ray[packet]; ray < list.first_ray[packet + 1]; ++ray)
      if (tree_of(out.trees, ray) != tree_of(out.trees, list.first_ray[packet]))
        refuse(section, fmt::format("the packet of ray {} has rays of two trees", out.first_ray + ray));
  for (const std::uint16_t visits : read_column<std::uint16_t>(decoder, section, "visits", block, packets))
    list.first_visit.push_back(list.first_visit.back() + visits);
  for (const std::uint8_t entries : read_column<std::uint8_t>(decoder, section, "entries", block, packets)) {
    if (entries > manifest_.packets.plan.most_entries)
      refuse(section, fmt::format("a packet has {} entries, where up to {} are possible", entries,
                                  manifest_.packets.plan.most_entries));
    list.first_entry.push_back(list.first_entry.back() + entries);
  }
  const std::uint64_t visits = list.first_visit.back();
  const auto node = read_column<std::uint32_t>(decoder, section, "node", block, visits);
  const auto lanes = read_column<std::uint8_t>(decoder, section, "lanes", block, visits);
  for (std::uint64_t i = 0; i < visits; ++i) list.visits.push_back({node[i], lanes[i]});
  list.entries = read_column<std::uint32_t>(decoder, section, "entry", block, list.first_entry.back());
}

reference::RayBlock TraceReader::read_block(std::uint64_t block, std::optional<cull::Design> steps_of) const {
  if (block >= blocks()) refuse("rays", fmt::format("there is no block {}", block));
  reference::RayBlock out;
  out.first_ray = first_ray_[block];
  out.rays.resize(first_ray_[block + 1] - first_ray_[block]);
  out.expected.resize(out.rays.size());
  ColumnDecoder decoder;
  read_rays(decoder, block, out);
  if (manifest_.trees.any()) read_trees(decoder, block, out);
  read_hits(decoder, block, out);
  if (steps_of) read_steps(decoder, block, *steps_of, out);
  if (manifest_.packets.any()) read_packets(decoder, block, out);
  return out;
}

void TraceReader::verify() const {
  ColumnDecoder decoder;
  std::vector<std::uint8_t> content;
  for (const IndexEntry& entry : index_) {
    const std::string what = describe(entry);
    const std::size_t width = places_[entry.section][entry.column].width;
    const std::vector<std::uint8_t> frame = read_frame(file_, entry, what.c_str());
    if (width == 0) continue;  // a type of a newer program
    ColumnDecoder::check_size(frame, entry.elements, width, path(), what);
    content.resize(entry.elements * width);
    decoder.decode(frame, entry.elements, width, entry.checksum, content.data(), path(), what);
  }
}

}  // namespace ctu::traces
