#include "traces/trace_writer.h"

#include <algorithm>
#include <cassert>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "model/base/version.h"
#include "traces/trace_hash.h"

namespace ctu::traces {
namespace {

constexpr std::size_t kImageBlockWords = 1u << 20;
constexpr std::uint16_t kImageSection = 0, kRaysSection = 1, kHitsSection = 2, kFirstStepsSection = 3;

bool has_keys(cull::Design design) { return cull::event_class(design) == cull::Design::MaskLut; }

/// Collects one member of many structures into a column and encodes it.
class ColumnSink {
 public:
  ColumnSink(ColumnEncoder& encoder, std::vector<EncodedColumn>& columns, std::uint16_t section)
      : encoder_(encoder), columns_(columns), section_(section) {}

  template <class T, class Items, class Get>
  void add(const Items& items, Get&& get) {
    std::vector<T> values(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) values[i] = static_cast<T>(get(items[i]));
    add(values);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    columns_.push_back(encoder_.encode(values.data(), values.size(), sizeof(T)));
    columns_.back().section = section_;
    columns_.back().column = next_++;
  }

 private:
  ColumnEncoder& encoder_;
  std::vector<EncodedColumn>& columns_;
  std::uint16_t section_, next_ = 0;
};

void encode_rays(ColumnSink sink, const std::vector<intersect::Ray>& rays, const std::vector<reference::RayTree>& trees,
                 bool with_trees) {
  using intersect::Ray;
  using reference::RayTree;
  for (int axis = 0; axis < 3; ++axis) sink.add<float>(rays, [=](const Ray& ray) { return ray.origin[axis]; });
  sink.add<float>(rays, [](const Ray& ray) { return ray.tmin; });
  for (int axis = 0; axis < 3; ++axis) sink.add<float>(rays, [=](const Ray& ray) { return ray.direction[axis]; });
  sink.add<float>(rays, [](const Ray& ray) { return ray.tmax; });
  sink.add<std::uint8_t>(rays, [](const Ray& ray) { return ray.kind; });
  if (!with_trees) return;
  sink.add<std::uint8_t>(trees, [](const RayTree& tree) { return tree.tree; });
  sink.add<std::uint32_t>(trees, [](const RayTree& tree) { return tree.own_tests; });
  sink.add<std::uint32_t>(trees, [](const RayTree& tree) { return tree.global_tests; });
}

void encode_hits(ColumnSink sink, const std::vector<intersect::Hit>& hits) {
  using intersect::Hit;
  sink.add<float>(hits, [](const Hit& hit) { return hit.t; });
  sink.add<float>(hits, [](const Hit& hit) { return hit.u; });
  sink.add<float>(hits, [](const Hit& hit) { return hit.v; });
  sink.add<std::uint32_t>(hits, [](const Hit& hit) { return hit.primitive; });
}

void encode_steps(ColumnSink sink, const reference::StepList& list, const StepColumns& has) {
  using reference::Step;
  std::vector<std::uint32_t> counts(list.rays());
  for (std::size_t ray = 0; ray < counts.size(); ++ray)
    counts[ray] = static_cast<std::uint32_t>(list.first_step[ray + 1] - list.first_step[ray]);
  sink.add(counts);
  sink.add(list.tail_dropped);
  sink.add<std::uint32_t>(list.steps, [](const Step& step) { return step.ref; });
  sink.add<std::uint8_t>(list.steps, [](const Step& step) { return step.dropped; });
  sink.add<std::uint8_t>(list.steps, [](const Step& step) { return step.lanes; });
  sink.add<std::uint16_t>(list.steps, [](const Step& step) { return step.detail; });
  if (has.keys) sink.add(list.keys);
  if (has.met) sink.add(list.met);
  if (has.spared) sink.add(list.spared);
}

/// How many belong to each, from where each begins.
template <class T, class Starts>
std::vector<T> counts_of(const Starts& starts) {
  std::vector<T> counts(starts.size() - 1);
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<T>(starts[i + 1] - starts[i]);
  return counts;
}

void encode_packets(ColumnSink sink, const reference::PacketList& list) {
  using reference::PacketVisit;
  sink.add(counts_of<std::uint8_t>(list.first_ray));
  sink.add(counts_of<std::uint16_t>(list.first_visit));
  sink.add(counts_of<std::uint8_t>(list.first_entry));
  sink.add<std::uint32_t>(list.visits, [](const PacketVisit& visit) { return visit.node; });
  sink.add<std::uint8_t>(list.visits, [](const PacketVisit& visit) { return visit.lanes; });
  sink.add(list.entries);
}

std::vector<cull::Design> stored_designs(const Manifest& manifest) {
  std::vector<cull::Design> designs;
  for (const DesignCounts& entry : manifest.designs)
    if (entry.stored) designs.push_back(entry.design);
  return designs;
}

}  // namespace

EncodedBlock BlockEncoder::encode(const reference::RayBlock& block, const std::vector<reference::StepList>& steps) {
  const std::size_t rays = block.rays.size();
  if (rays > kMaxRaysPerBlock || block.expected.size() != rays || steps.size() != designs_.size() ||
      (with_trees_ && block.trees.size() != rays))
    throw Error("trace", "a block does not have what the trace promises", "");
  if (in_packets_ && (!block.packets.walked() || block.packets.first_ray.back() != rays))
    throw Error("trace", "a block's packets are not walked, or not of its rays", "");
  EncodedBlock encoded;
  encoded.rays = rays;
  encode_rays({encoder_, encoded.columns, kRaysSection}, block.rays, block.trees, with_trees_);
  encode_hits({encoder_, encoded.columns, kHitsSection}, block.expected);
  for (std::size_t i = 0; i < designs_.size(); ++i) {
    if (steps[i].rays() != rays) throw Error("trace", "a block has not as many event sequences as rays", "");
    encode_steps({encoder_, encoded.columns, static_cast<std::uint16_t>(kFirstStepsSection + i)}, steps[i],
                 {has_keys(designs_[i]), with_met_, in_packets_});
  }
  if (in_packets_)
    encode_packets({encoder_, encoded.columns, static_cast<std::uint16_t>(kFirstStepsSection + designs_.size())},
                   block.packets);
  return encoded;
}

TraceWriter::TraceWriter(const std::string& path, Manifest manifest, const accel::Image& image,
                         const cull::CompressionLut* compression)
    : manifest_(std::move(manifest)),
      stored_designs_(stored_designs(manifest_)),
      with_met_(image.layout.primitive_boxes),
      encoder_(stored_designs_, with_met_, manifest_.packets.any(), manifest_.trees.any()),
      file_(path) {
  manifest_.tool = std::string("ctusim ") + tool_version();
  manifest_.ray_count = 0;
  manifest_.image.size_bytes = image.bytes.size();
  manifest_.image.shape = image;
  manifest_.image.shape.bytes = {};
  manifest_.sections = {image_section(), rays_section(manifest_.trees.any()), hits_section()};
  for (const cull::Design design : stored_designs_)
    manifest_.sections.push_back(
        steps_section(std::string(cull::to_string(design)), {has_keys(design), with_met_, manifest_.packets.any()}));
  if (manifest_.packets.any()) manifest_.sections.push_back(packets_section());
  if (manifest_.masks.entries != 0) manifest_.sections.push_back(compression_section());

  const FileHeader header = make_header(manifest_.format_minor());
  file_.write(&header, sizeof header);
  add_image(image);
  assert((manifest_.masks.entries != 0) == (compression != nullptr));
  if (compression != nullptr) add_compression(*compression);
}

void TraceWriter::add_image(const accel::Image& image) {
  assert(image.bytes.size() % sizeof(std::uint32_t) == 0);
  const std::size_t words = image.bytes.size() / sizeof(std::uint32_t);
  ColumnEncoder encoder;
  for (std::size_t first = 0, block = 0; first < words; first += kImageBlockWords, ++block) {
    const std::size_t count = std::min(kImageBlockWords, words - first);
    std::vector<EncodedColumn> column;
    column.push_back(encoder.encode(image.bytes.data() + first * sizeof(std::uint32_t), count, sizeof(std::uint32_t)));
    column.back().section = kImageSection;
    add_columns(column, static_cast<std::uint32_t>(block));
  }
}

void TraceWriter::add_compression(const cull::CompressionLut& lut) {
  std::vector<EncodedColumn> column;
  column.push_back(ColumnEncoder().encode(lut.bits().data(), lut.bits().size(), sizeof(std::uint64_t)));
  column.back().section = static_cast<std::uint16_t>(manifest_.sections.size() - 1);
  add_columns(column, 0);
}

void TraceWriter::add_columns(const std::vector<EncodedColumn>& columns, std::uint32_t block) {
  for (const EncodedColumn& column : columns) {
    index_.push_back({column.section, column.column, block, file_.position(),
                      static_cast<std::uint32_t>(column.frame.size()), column.elements, column.checksum});
    file_.write(column.frame.data(), column.frame.size());
  }
}

void TraceWriter::add(const EncodedBlock& block) {
  if (block.rays == 0) return;
  add_columns(block.columns, blocks_++);
  manifest_.ray_count += block.rays;
}

void TraceWriter::add(const reference::RayBlock& block, const std::vector<reference::StepList>& steps) {
  add(encoder_.encode(block, steps));
}

std::string TraceWriter::finish(std::vector<DesignCounts> designs, std::vector<Difference> differences) {
  manifest_.designs = std::move(designs);
  manifest_.differences = std::move(differences);
  FileFooter footer;
  const std::string text = to_json(manifest_);
  footer.manifest_offset = file_.position();
  footer.manifest_bytes = text.size();
  footer.manifest_checksum = hash64(text.data(), text.size());
  file_.write_skippable(text.data(), text.size());
  const std::size_t index_bytes = index_.size() * sizeof(IndexEntry);
  footer.index_offset = file_.position();
  footer.index_entries = index_.size();
  footer.index_checksum = hash64(index_.data(), index_bytes);
  file_.write_skippable(index_.data(), index_bytes);
  seal(footer);
  file_.write(&footer, sizeof footer);
  file_.commit();
  return trace_hash(manifest_, index_);
}

}  // namespace ctu::traces
