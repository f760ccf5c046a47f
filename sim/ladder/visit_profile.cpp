#include "sim/ladder/visit_profile.h"

#include <algorithm>
#include <bit>
#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/mask_words.h"
#include "model/pipeline/table_banks.h"
#include "model/pipeline/table_lines.h"
#include "model/pipeline/unit_image.h"

namespace ctu::ladder {
namespace {

using pipeline::ByteSpan;
using reference::Step;

int age_bucket(std::uint32_t age) {
  if (age < 2) return 0;
  const int octave = std::bit_width(age) - 1;
  return std::min(kAgeBuckets - 1, 2 * octave - 1 + static_cast<int>((age >> (octave - 1)) & 1));
}

/// Counts the lines of one fetch stage.
class LineCounter {
 public:
  LineCounter(std::uint64_t first_byte, std::uint64_t end_byte, const pipeline::MemoryConfig& memory)
      : line_shift_(std::countr_zero(static_cast<unsigned>(memory.line_bytes))),
        row_shift_(std::countr_zero(static_cast<unsigned>(memory.row_bytes / memory.line_bytes * memory.channels))),
        channels_(static_cast<std::uint64_t>(memory.channels)),
        base_(first_byte >> line_shift_),
        stack_(((std::max(end_byte, first_byte + 1) - 1) >> line_shift_) - base_ + 1) {
    for (auto& rows : rows_) rows.resize(kRows);
  }

  void visit(LineProfile& profile, const ByteSpan& span, std::uint32_t now) {
    begin();
    add(profile, span, now);
    end(profile);
  }

  // The same for a visit that asks for several spans.
  void begin() {
    farthest_ = -1;
    lines_.clear();
    if (any_recent_) youngest_.fill(UINT32_MAX);
    any_recent_ = false;
  }
  void add(LineProfile& profile, const ByteSpan& span, std::uint32_t now) {
    profile.bytes += span.last - span.first + 1;
    for (std::uint64_t line = span.first >> line_shift_; line <= span.last >> line_shift_; ++line)
      if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) {
        lines_.push_back(line);
        look_up(profile, line, now);
      }
  }
  void end(LineProfile& profile) {
    if (farthest_ < 0) return;
    ++profile.visits;
    ++profile.by_lines[std::min<std::size_t>(lines_.size(), kMostLines)];
    ++profile.by_farthest[static_cast<std::size_t>(farthest_)];
    if (!any_recent_) return;
    for (int c = std::min((farthest_ + 3) / 4, kSizeClasses); c < kSizeClasses; ++c)
      if (youngest_[static_cast<std::size_t>(c)] < kOldest)
        ++profile.recent[static_cast<std::size_t>(c)]
                        [static_cast<std::size_t>(age_bucket(youngest_[static_cast<std::size_t>(c)]))];
  }

 private:
  using Times = std::array<std::uint32_t, kSizeClasses>;  ///< when a cache of this class last took the line in

  void look_up(LineProfile& profile, std::uint64_t line, std::uint32_t now) {
    const LineStack::Use use = stack_.use(line - base_);
    if (use.place == came_.size()) came_.push_back({});
    Times& came = came_[use.place];
    ++profile.lookups;
    ++profile.lines[static_cast<std::size_t>(use.group)];
    farthest_ = std::max(farthest_, use.group);
    const int missing =
        std::min((use.group + 3) / 4, kSizeClasses);  // of the classes below, whose caches lost the line
    for (int c = 0; c < missing; ++c) {
      came[static_cast<std::size_t>(c)] = now;
      count_row(profile, c, line);
    }
    if (now - came[0] >= kOldest) return;  // larger caches had it at least as long
    any_recent_ = true;
    for (int c = missing; c < kSizeClasses; ++c)
      youngest_[static_cast<std::size_t>(c)] =
          std::min(youngest_[static_cast<std::size_t>(c)], now - came[static_cast<std::size_t>(c)]);
  }

  /// Neighbouring lines lie in rows of neighbouring channels.
  void count_row(LineProfile& profile, int size_class, std::uint64_t line) {
    const auto c = static_cast<std::size_t>(size_class);
    const std::uint64_t row = (line >> row_shift_) * channels_ + line % channels_;
    Row& last = rows_[c][row % kRows];
    const std::uint64_t number = ++fetched_[c];
    if (last.row == row + 1) {
      const int bucket = std::bit_width(number - last.number) - 1;
      if (bucket < kRowBuckets) ++profile.row_distance[c][static_cast<std::size_t>(bucket)];
    }
    last = {row + 1, number};
  }

  static constexpr std::uint32_t kOldest = 1u << (kAgeBuckets / 2);
  static constexpr std::size_t kRows = 1024;
  struct Row {
    std::uint64_t row = 0, number = 0;
  };

  int line_shift_, row_shift_;
  std::uint64_t channels_, base_;
  LineStack stack_;
  std::vector<Times> came_;  ///< by place
  int farthest_ = -1;
  std::vector<std::uint64_t> lines_;  ///< of the visit so far
  bool any_recent_ = true;
  Times youngest_{};
  std::array<std::vector<Row>, kSizeClasses> rows_;
  std::array<std::uint64_t, kSizeClasses> fetched_{};
};

/// Lanes of a node whose object masks are full, read when they are first asked for.
class FullLanes {
 public:
  FullLanes(const accel::Image& image, const cull::MaskTester& tester)
      : image_(image),
        lut_(tester.compression_lut()),
        resolution_(tester.options().resolution),
        words_(static_cast<std::size_t>(cull::words_per_mask(resolution_))),
        masks_(4 * words_),
        known_(tester.design() == cull::Design::None ? 0 : image.node_count, kUnknown) {}

  unsigned operator()(std::uint32_t node) {
    if (known_.empty()) return 0;
    if (known_[node] == kUnknown) known_[node] = read(node);
    return known_[node];
  }

  /// Where masks are compressed: the lane's entry of the compression LUT.
  std::uint32_t mask_index(std::uint32_t node, int lane) const {
    std::uint64_t index = 0;
    accel::read_mask(image_, node, lane, &index);
    return static_cast<std::uint32_t>(index);
  }
  bool compressed() const { return lut_ != nullptr; }

 private:
  static constexpr std::uint8_t kUnknown = 0xFF;

  std::uint8_t read(std::uint32_t node) {
    if (node >= image_.masked_nodes()) return 15;
    if (!compressed()) {
      for (int lane = 0; lane < 4; ++lane)
        accel::read_mask(image_, node, lane, masks_.data() + static_cast<std::size_t>(lane) * words_);
      return static_cast<std::uint8_t>(cull::full_lanes(masks_.data(), resolution_));
    }
    unsigned full = 0;
    for (int lane = 0; lane < 4; ++lane)
      if (mask_index(node, lane) == static_cast<std::uint32_t>(lut_->entries() - 1)) full |= 1u << lane;
    return static_cast<std::uint8_t>(full);
  }

  const accel::Image& image_;
  const cull::CompressionLut* lut_;
  int resolution_;
  std::size_t words_;
  std::vector<std::uint64_t> masks_;
  std::vector<std::uint8_t> known_;
};

/// A ray on its way.
struct Ray {
  std::shared_ptr<const reference::RayBlock> block;
  const Step *first = nullptr, *step = nullptr, *end = nullptr;
  const std::uint32_t* key = nullptr;
  const std::uint16_t* met = nullptr;
  std::uint32_t index = 0;
  std::uint8_t tail_dropped = 0;
  int depth = 0, spilled = 0;
};

/// What table_lines.h asks of a source of outcomes: the keys of the node at hand.
struct KeysAtHand {
  pipeline::LaneKeys lanes;
  pipeline::LaneKeys keys(const pipeline::NodeToken&) const { return lanes; }
};

class VisitCounter {
 public:
  VisitCounter(const accel::Image& image, const cull::MaskTester& tester, const pipeline::UnitConfig& config,
               reference::RayFeed& feed)
      : image_(image),
        config_(config),
        feed_(feed),
        keyed_(cull::reads_tables(tester.design())),
        culls_(tester.design() != cull::Design::None),
        tables_(tester, config.mask_test.rows, config.mask_test.projection_tables),
        banks_(config, tables_),
        full_lanes_(image, tester),
        nodes_(image.node_base, image.triangle_base, config.memory),
        leaves_(image.triangle_base, std::max<std::uint64_t>(image.bytes.size(), image.triangle_base + 1),
                config.memory),
        rays_(static_cast<std::size_t>(config.unit.contexts)),
        phase_rays_(std::max(kPhaseRays, (feed.total_rays() + kPhases - 1) / kPhases)) {
    if (config.table_cache.bytes > 0 && !tables_.tables().empty()) {
      unit_image_.emplace(image, tester, false);
      const pipeline::MemoryMap map(config, *unit_image_);
      layout_.emplace(config, tables_, map, unit_image_->compressed());
      table_lines_.emplace(map.table_base, layout_->end(), config.memory);
    }
  }

  VisitProfile count() {
    next_block();
    const double apart = rounds_apart();
    std::size_t started = 0, under_way = 0;
    for (std::uint64_t round = 0; under_way > 0 || (started < rays_.size() && block_ != nullptr); ++round) {
      for (; started < rays_.size() && static_cast<double>(started) * apart <= static_cast<double>(round); ++started)
        under_way += begin(rays_[started]);
      for (std::size_t slot = 0; slot < started; ++slot) {
        Ray& ray = rays_[slot];
        if (ray.step == ray.end) continue;
        visit(ray);
        if (ray.step != ray.end) continue;
        finish(ray);
        if (!begin(ray)) --under_way;
      }
    }
    for (std::size_t t = 0; t < banks_.tables().size(); ++t) {
      const auto usage = banks_.usage(t);
      const cull::OnChipTable& table = banks_.tables()[t];
      profile_.tables.push_back(
          {table.name, table.rows, table.row_bits, usage.reads, usage.shared_reads, usage.rows_used});
    }
    return std::move(profile_);
  }

 private:
  /// Rays come in one after the other, as others end, so that at any time the contexts are spread over the length of a
  /// walk: that is how many rounds lie between two of them.
  double rounds_apart() const {
    if (block_ == nullptr || block_->steps.rays() == 0) return 0;
    const double visits = static_cast<double>(block_->steps.steps.size()) / static_cast<double>(block_->steps.rays());
    return visits / static_cast<double>(rays_.size());
  }

  Phase& phase() { return profile_.phases.back(); }

  void next_block() {
    next_ray_ = 0;
    do {
      block_ = feed_.next();
    } while (block_ != nullptr && block_->rays.empty());
  }

  /// The context takes the next ray that visits anything.
  bool begin(Ray& ray) {
    while (block_ != nullptr) {
      if (profile_.phases.empty() || phase().rays >= phase_rays_) profile_.phases.push_back({});
      ++phase().rays;
      const reference::StepList& list = block_->steps;
      const std::uint32_t i = next_ray_++;
      ray.block = block_;
      ray.index = i;
      ray.first = ray.step = list.steps.data() + list.first_step[i];
      ray.end = list.steps.data() + list.first_step[i + 1];
      ray.key = keyed_ ? list.keys.data() + list.first_key[i] : nullptr;
      ray.met = image_.layout.primitive_boxes ? list.met.data() + list.first_met[i] : nullptr;
      ray.tail_dropped = list.tail_dropped[i];
      ray.depth = ray.spilled = 0;
      if (next_ray_ == block_->rays.size()) next_block();
      if (ray.step == ray.end) continue;
      ++phase().entered;
      return true;
    }
    ray.step = ray.end;
    return false;
  }

  void visit(Ray& ray) {
    const Step& step = *ray.step;
    ++now_;
    if (step.is_leaf())
      visit_leaf(ray, step);
    else
      visit_node(ray, step);
    ++ray.step;
    const bool pops = step.is_leaf() || step.survivors() == 0;
    if (ray.step == ray.end) {
      if (pops) pop(ray, ray.tail_dropped, false);
    } else if (pops) {
      pop(ray, ray.step->dropped, true);
    }
  }
  void finish(const Ray& ray) {
    phase().longest_visits = std::max(phase().longest_visits, static_cast<std::uint64_t>(ray.end - ray.first));
  }

  void visit_node(Ray& ray, const Step& step) {
    Phase& p = phase();
    const int hits = std::popcount(step.box_hits()), survivors = std::popcount(step.survivors());
    ++p.nodes;
    p.box_hits += static_cast<unsigned>(hits);
    p.culled += static_cast<unsigned>(hits - survivors);
    p.uncertain += static_cast<unsigned>(std::popcount(step.uncertain()));
    ++p.survivors[static_cast<std::size_t>(survivors)];
    const std::uint64_t first = image_.node_address(step.ref);
    const std::uint64_t bytes =
        step.ref < image_.masked_nodes() ? image_.node_stride_bytes : image_.bare_node_stride_bytes;
    nodes_.visit(p.node, {first, first + bytes - 1}, now_);
    if (culls_) ask_tables(ray, step);
    for (int push = 1; push < survivors; ++push) {
      if (ray.depth - ray.spilled == config_.stack.entries) {
        ray.spilled += config_.stack.spill_batch;
        ++p.spills;
      }
      ++ray.depth;
      ++p.pushes;
    }
    p.deepest = std::max(p.deepest, static_cast<std::uint64_t>(ray.depth));
  }

  void ask_tables(Ray& ray, const Step& step) {
    Phase& p = phase();
    const unsigned full = full_lanes_(step.ref);
    KeysAtHand at_hand;
    pipeline::LaneKeys& lanes = at_hand.lanes;
    for (unsigned rest = step.box_hits(); rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      const std::uint32_t key = keyed_ ? *ray.key++ : 0;
      if ((full >> lane & 1) != 0) {
        ++p.lanes_unasked;
        continue;
      }
      lanes.key[lanes.count] = key;
      if (full_lanes_.compressed()) lanes.mask_index[lanes.count] = full_lanes_.mask_index(step.ref, lane);
      ++lanes.count;
    }
    context_.ray = ray.block->first_ray + ray.index;
    context_.visits = static_cast<std::uint32_t>(ray.step - ray.first);
    const int turns = banks_.read(lanes, context_);
    ++p.asked_turns[static_cast<std::size_t>(lanes.count)][static_cast<std::size_t>(std::min(turns, 12))];
    if (!table_lines_) return;
    table_lines_->begin();
    pipeline::for_each_read(tables_, lanes, context_, [&](const cull::TableRead& read, std::uint32_t mask_index) {
      table_lines_->add(p.table, layout_->bytes(read, mask_index), now_);
    });
    table_lines_->end(p.table);
  }

  void visit_leaf(Ray& ray, const Step& step) {
    Phase& p = phase();
    const int primitives = accel::leaf_count(step.ref);
    const int tested = ray.met != nullptr ? std::popcount(*ray.met++ & ((1u << primitives) - 1)) : primitives;
    ++p.leaves;
    p.leaf_primitives += static_cast<unsigned>(primitives);
    p.triangles += static_cast<unsigned>(tested);
    p.boxed_out += static_cast<unsigned>(primitives - tested);
    ++p.tests[static_cast<std::size_t>(tested)];
    const std::uint64_t first = image_.triangle_address(accel::leaf_first(step.ref));
    leaves_.visit(p.leaf, {first, first + static_cast<std::uint64_t>(primitives) * image_.triangle_stride_bytes - 1},
                  now_);
  }

  /// As traversal_stack pops: dropped entries, then the one that is visited next, or none.
  void pop(Ray& ray, int dropped, bool goes_on) {
    Phase& p = phase();
    p.dropped += static_cast<unsigned>(dropped);
    for (int left = dropped + (goes_on ? 1 : 0); left > 0 && ray.depth > 0; --left) {
      if (ray.depth == ray.spilled) {
        ray.spilled -= config_.stack.spill_batch;
        ++p.refills;
      }
      --ray.depth;
      ++p.pops;
    }
  }

  const accel::Image& image_;
  const pipeline::UnitConfig& config_;
  reference::RayFeed& feed_;
  bool keyed_, culls_;
  cull::OnChipTables tables_;
  pipeline::TableBanks banks_;
  FullLanes full_lanes_;
  LineCounter nodes_, leaves_;
  std::optional<pipeline::UnitImage> unit_image_;
  std::optional<pipeline::TableLayout> layout_;
  std::optional<LineCounter> table_lines_;
  std::vector<Ray> rays_;
  std::uint64_t phase_rays_;
  pipeline::Context context_;
  std::shared_ptr<const reference::RayBlock> block_;
  std::uint32_t next_ray_ = 0, now_ = 0;
  VisitProfile profile_;
};

void add(LineProfile& sum, const LineProfile& other) {
  sum.visits += other.visits;
  sum.lookups += other.lookups;
  sum.bytes += other.bytes;
  const auto add_all = [](auto& to, const auto& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  };
  add_all(sum.lines, other.lines);
  add_all(sum.by_farthest, other.by_farthest);
  add_all(sum.by_lines, other.by_lines);
  for (std::size_t c = 0; c < sum.recent.size(); ++c) add_all(sum.recent[c], other.recent[c]);
  for (std::size_t c = 0; c < sum.row_distance.size(); ++c) add_all(sum.row_distance[c], other.row_distance[c]);
}

}  // namespace

std::uint64_t VisitProfile::rays() const {
  std::uint64_t sum = 0;
  for (const Phase& phase : phases) sum += phase.rays;
  return sum;
}

std::string profile_key(const pipeline::UnitConfig& config) {
  const auto& m = config.mask_test;
  return fmt::format("{} {} {} {} {} table_cache {} line {} row {} channels {} contexts {} stack {} {}",
                     cull::to_string(m.design), cull::to_string(m.rows), m.projection_tables, m.banks, m.ports,
                     config.table_cache.bytes > 0, config.memory.line_bytes, config.memory.row_bytes,
                     config.memory.channels, config.unit.contexts, config.stack.entries, config.stack.spill_batch);
}

VisitProfile count_visits(const accel::Image& image, const cull::MaskTester& tester, const pipeline::UnitConfig& config,
                          reference::RayFeed& feed) {
  if (feed.packets().any())
    throw Error("--engine estimate", "the rays of this trace travel in packets, of which the closed forms know nothing",
                "give --engine cycle, or record without --packets");
  return VisitCounter(image, tester, config, feed).count();
}

Phase& operator+=(Phase& sum, const Phase& other) {
  sum.rays += other.rays;
  sum.entered += other.entered;
  sum.nodes += other.nodes;
  sum.leaves += other.leaves;
  sum.box_hits += other.box_hits;
  sum.culled += other.culled;
  sum.uncertain += other.uncertain;
  sum.dropped += other.dropped;
  sum.triangles += other.triangles;
  sum.boxed_out += other.boxed_out;
  sum.lanes_unasked += other.lanes_unasked;
  for (std::size_t l = 0; l < sum.asked_turns.size(); ++l)
    for (std::size_t t = 0; t < sum.asked_turns[l].size(); ++t) sum.asked_turns[l][t] += other.asked_turns[l][t];
  for (std::size_t i = 0; i < sum.survivors.size(); ++i) sum.survivors[i] += other.survivors[i];
  for (std::size_t i = 0; i < sum.tests.size(); ++i) sum.tests[i] += other.tests[i];
  sum.leaf_primitives += other.leaf_primitives;
  sum.pushes += other.pushes;
  sum.pops += other.pops;
  sum.spills += other.spills;
  sum.refills += other.refills;
  sum.deepest = std::max(sum.deepest, other.deepest);
  sum.longest_visits = std::max(sum.longest_visits, other.longest_visits);
  add(sum.node, other.node);
  add(sum.leaf, other.leaf);
  add(sum.table, other.table);
  return sum;
}

}  // namespace ctu::ladder
