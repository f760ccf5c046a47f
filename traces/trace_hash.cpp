#include "traces/trace_hash.h"

#include "model/base/hash.h"

namespace ctu::traces {

std::string trace_hash(const Manifest& manifest, const std::vector<IndexEntry>& index) {
  Hasher hasher;
  hasher.add(identity_text(manifest));
  for (const Section& section : manifest.sections) {
    hasher.add("\n" + section.name);
    for (const Column& column : section.columns) hasher.add(" " + column.name + ":" + column.type);
  }
  for (const IndexEntry& entry : index) {
    const std::uint64_t words[] = {entry.section, entry.column, entry.block, entry.elements, entry.checksum};
    hasher.add(words, sizeof words);
  }
  return hasher.digest().hex();
}

}  // namespace ctu::traces
