// The lines that hold the rows of tables a node's lanes read.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/cull/on_chip_tables.h"
#include "model/pipeline/cache.h"
#include "model/pipeline/memory_map.h"
#include "model/pipeline/table_reads.h"
#include "model/pipeline/tokens.h"

namespace ctu::pipeline {

/// Where the tables lie in memory, one behind the other: row r of one begins at its base + r * stride, the stride being
/// the bytes of a row rounded up to a power of two, so that no row shares more lines than it must.
class TableLayout {
 public:
  /// `compressed`: object masks are.
  TableLayout(const UnitConfig& config, const cull::OnChipTables& tables, const MemoryMap& map, bool compressed);

  /// The bytes that a read wants: the whole row, or of a row that holds a bit for every entry of the compression LUT
  /// the byte with the lane's bit.
  ByteSpan bytes(const cull::TableRead& read, std::uint32_t mask_index) const {
    const Table& table = tables_[read.table];
    const std::uint64_t first = table.base + (static_cast<std::uint64_t>(read.row) << table.stride_shift);
    if (table.by_bit) return {first + mask_index / 8, first + mask_index / 8};
    return {first, first + table.row_bytes - 1};
  }
  /// Where a table's first row lies, and the log2 of the bytes from row to row.
  std::uint64_t base(std::size_t table) const { return tables_[table].base; }
  int stride_shift(std::size_t table) const { return tables_[table].stride_shift; }
  /// Whether a read wants one byte of the table's rows.
  bool is_read_by_bit(std::size_t table) const { return tables_[table].by_bit; }
  /// First byte behind the tables.
  std::uint64_t end() const { return end_; }

 private:
  struct Table {
    std::uint64_t base = 0;
    std::uint32_t row_bytes = 0;
    int stride_shift = 0;
    bool by_bit = false;
  };
  std::vector<Table> tables_;
  std::uint64_t end_ = 0;
};

/// The distinct lines of a node in the order of its lanes; Dedup's in two rounds, as its second rows are known from its
/// first.
template <class Source>
class TableLines {
 public:
  using Token = NodeToken;
  using Done = NodeToken;
  static constexpr int kRounds = 2;
  static constexpr bool kServesPackets = false;
  static constexpr bool kMayNeedNone = true;

  TableLines(const UnitConfig& config, const cull::OnChipTables& tables, const UnitImage& image,
             const Contexts& contexts, Source& source)
      : tables_(tables),
        layout_(config, tables, MemoryMap(config, image), image.compressed()),
        contexts_(contexts),
        source_(source),
        design_(config.mask_test.design),
        line_shift_(std::countr_zero(static_cast<unsigned>(config.memory.line_bytes))),
        second_round_(static_cast<std::size_t>(contexts.count())) {}

  static Done done(const Token& token) { return token; }

  /// Collects the lines of the token's round; the bytes it asks for, 0 if it needs none. Throws Error as for_each_read
  /// does.
  std::uint64_t start(const Token& token) {
    count_ = next_ = 0;
    bytes_ = 0;
    const bool second_round = second_round_[token.slot];
    for_each_read(tables_, source_.keys(token), contexts_[token.slot],
                  [&](const cull::TableRead& read, std::uint32_t mask_index) {
                    if (is_second_read(design_, read.table) == second_round) add(layout_.bytes(read, mask_index));
                  });
    return bytes_;
  }
  LineNumber current() const { return line_[next_]; }
  bool next() { return ++next_ < count_; }

  /// The lines of a round are there: whether there is another one.
  bool needs_more(const Token& token) {
    const bool more = reads_twice(design_) && !second_round_[token.slot];
    second_round_[token.slot] = more;
    return more;
  }

 private:
  /// Lines of all rows of a node: at most two of a row of R^3 bits, as lines have 32 bytes and more.
  static constexpr int kMaxLines = 2 * cull::kMaxReadsOfLane * intersect::kLanes;

  void add(const ByteSpan& span) {
    bytes_ += span.last - span.first + 1;
    for (LineNumber line = span.first >> line_shift_; line <= span.last >> line_shift_; ++line) {
      int i = 0;
      while (i < count_ && line_[i] != line) ++i;
      if (i == count_) line_[count_++] = line;
    }
  }

  const cull::OnChipTables& tables_;
  TableLayout layout_;
  const Contexts& contexts_;
  Source& source_;
  cull::Design design_;
  int line_shift_;
  std::vector<bool> second_round_;  // by context
  int count_ = 0, next_ = 0;
  std::uint64_t bytes_ = 0;
  LineNumber line_[kMaxLines] = {};
};

}  // namespace ctu::pipeline
