// A trace taken apart and put together again: for tests that need files which lie while every checksum is right.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "model/base/hash.h"
#include "traces/columns.h"
#include "traces/file.h"

namespace ctu::traces::test {

using Bytes = std::vector<std::uint8_t>;

/// A trace taken apart, to be changed and put together again with every checksum right.
struct Parts {
  struct Chunk {
    IndexEntry entry;
    Bytes frame;
  };
  std::string manifest;
  std::vector<Chunk> chunks;  ///< in file order

  explicit Parts(const std::string& path) {
    const InputFile file(path);
    const FileLayout layout = read_layout(file);
    manifest = layout.manifest;
    for (const IndexEntry& entry : layout.index) {
      Bytes frame(entry.stored_bytes);
      file.read_at(entry.offset, frame.data(), frame.size(), "test");
      chunks.push_back({entry, frame});
    }
  }

  void replace(const std::string& from, const std::string& to) {
    const auto place = manifest.find(from);
    ASSERT_NE(place, std::string::npos) << from;
    manifest.replace(place, from.size(), to);
  }

  Chunk& chunk_of(int section, int column) {
    return *std::find_if(chunks.begin(), chunks.end(), [&](const Chunk& chunk) {
      return chunk.entry.section == section && chunk.entry.column == column;
    });
  }

  /// Of a chunk's column, what it holds now and what it is to hold.
  template <class T>
  static std::vector<T> elements(const Chunk& chunk) {
    std::vector<T> values(chunk.entry.elements);
    ColumnDecoder().decode(chunk.frame, values.size(), sizeof(T), chunk.entry.checksum, values.data(), "", "");
    return values;
  }
  template <class T>
  static void set_elements(Chunk& chunk, const std::vector<T>& values) {
    const EncodedColumn column = ColumnEncoder().encode(values.data(), values.size(), sizeof(T));
    chunk.frame = column.frame;
    chunk.entry.elements = column.elements;
    chunk.entry.checksum = column.checksum;
  }

  void write(const std::string& path) {
    OutputFile file(path);
    const FileHeader header = make_header();
    file.write(&header, sizeof header);
    std::vector<IndexEntry> index;
    for (Chunk& chunk : chunks) {
      chunk.entry.offset = file.position();
      chunk.entry.stored_bytes = static_cast<std::uint32_t>(chunk.frame.size());
      index.push_back(chunk.entry);
      file.write(chunk.frame.data(), chunk.frame.size());
    }
    FileFooter footer;
    footer.manifest_offset = file.position();
    footer.manifest_bytes = manifest.size();
    footer.manifest_checksum = hash64(manifest.data(), manifest.size());
    file.write_skippable(manifest.data(), manifest.size());
    footer.index_offset = file.position();
    footer.index_entries = index.size();
    footer.index_checksum = hash64(index.data(), index.size() * sizeof(IndexEntry));
    file.write_skippable(index.data(), index.size() * sizeof(IndexEntry));
    seal(footer);
    file.write(&footer, sizeof footer);
    file.commit();
  }
};

}  // namespace ctu::traces::test
