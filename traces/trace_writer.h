// Writes a trace block by block, in bounded memory. Blocks are encoded (by any thread, each with its own BlockEncoder)
// and then added in order.
#pragma once

#include <string>
#include <vector>

#include "model/accel/image.h"
#include "model/cull/compression_lut.h"
#include "model/reference/ray_block.h"
#include "traces/columns.h"
#include "traces/file.h"
#include "traces/manifest.h"

namespace ctu::traces {

/// Rays, hits and steps of one block, ready to be written.
struct EncodedBlock {
  std::uint64_t rays = 0;
  std::vector<EncodedColumn> columns;
};

class BlockEncoder {
 public:
  /// `designs`: whose steps are stored, in the order in which `encode` gets them; `with_met`: with what ray boxes meet.
  BlockEncoder(std::vector<cull::Design> designs, bool with_met, bool in_packets, bool with_trees)
      : designs_(std::move(designs)), with_met_(with_met), in_packets_(in_packets), with_trees_(with_trees) {}
  /// `block` with all but its steps, which are those of `steps`.
  EncodedBlock encode(const reference::RayBlock& block, const std::vector<reference::StepList>& steps);

 private:
  std::vector<cull::Design> designs_;
  bool with_met_, in_packets_, with_trees_;
  ColumnEncoder encoder_;
};

class TraceWriter {
 public:
  /// Creates the file and writes the image, and what its masks are compressed with when the manifest says that they
  /// are. The designs that the manifest calls stored are those whose steps come with every block. Throws Error when the
  /// file cannot be written.
  TraceWriter(const std::string& path, Manifest manifest, const accel::Image& image,
              const cull::CompressionLut* compression = nullptr);

  BlockEncoder make_encoder() const {
    return BlockEncoder(stored_designs_, with_met_, manifest_.packets.any(), manifest_.trees.any());
  }
  void add(const EncodedBlock& block);
  void add(const reference::RayBlock& block, const std::vector<reference::StepList>& steps);

  /// Writes manifest, index and footer, and gives the file its name. Returns the trace hash.
  std::string finish(std::vector<DesignCounts> designs, std::vector<Difference> differences);

 private:
  void add_image(const accel::Image& image);
  void add_compression(const cull::CompressionLut& lut);
  void add_columns(const std::vector<EncodedColumn>& columns, std::uint32_t block);

  Manifest manifest_;
  std::vector<cull::Design> stored_designs_;
  bool with_met_;
  BlockEncoder encoder_;
  OutputFile file_;
  std::vector<IndexEntry> index_;
  std::uint32_t blocks_ = 0;
};

}  // namespace ctu::traces
