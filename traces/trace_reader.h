// Reads a trace: what it says about itself at once, the image and the blocks when asked. Whatever the bytes of the file
// are, each function returns what was written or throws Error naming the file and the section.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/accel/image.h"
#include "model/cull/compression_lut.h"
#include "model/reference/ray_block.h"
#include "traces/file.h"
#include "traces/manifest.h"

namespace ctu::traces {

/// Const after construction; blocks may be read from many threads.
class TraceReader {
 public:
  explicit TraceReader(const std::string& path);

  const std::string& path() const { return file_.path(); }
  const Manifest& manifest() const { return manifest_; }
  std::string hash() const { return hash_; }
  std::uint64_t size_bytes() const { return file_.size_bytes(); }

  std::uint64_t rays() const { return first_ray_.back(); }
  std::uint64_t blocks() const { return first_ray_.size() - 1; }
  std::uint64_t first_ray(std::uint64_t block) const { return first_ray_[block]; }
  std::uint64_t block_of(std::uint64_t ray) const;  ///< ray < rays()
  bool has_steps(cull::Design design) const;        ///< of its event class
  bool has_primitive_boxes() const { return manifest_.image.shape.layout.primitive_boxes; }

  /// What the object masks are compressed with; null when they are not.
  const std::shared_ptr<const cull::CompressionLut>& compression() const { return compression_; }

  /// The image the steps refer to, validated; where masks are compressed, every index is one of the LUT.
  accel::Image read_image() const;

  /// One block, with its packets if it has any, and with the steps of a design that has them. All are whole and add up;
  /// whether they are walks through the image is for validate_block to say.
  reference::RayBlock read_block(std::uint64_t block, std::optional<cull::Design> steps_of = std::nullopt) const;

  /// Reads every byte of the file against its checksum, of sections that are not known to this program too.
  void verify() const;

 private:
  struct ColumnPlace {
    std::size_t width = 0;
    std::vector<std::uint32_t> entries;  ///< index entry of each block
  };
  void index_columns();
  void expect_columns(const Section& wanted) const;
  void count_rays();
  void expect_rays(const Section& wanted) const;
  void read_compression();
  void check_masks(const accel::Image& image) const;
  const ColumnPlace& place(const std::string& section, const std::string& column) const;
  template <class T>
  std::vector<T> read_column(ColumnDecoder& decoder, const std::string& section, const char* column,
                             std::uint64_t block, std::optional<std::uint64_t> elements) const;
  void read_rays(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const;
  void read_trees(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const;
  void read_hits(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const;
  void read_steps(ColumnDecoder& decoder, std::uint64_t block, cull::Design design, reference::RayBlock& out) const;
  void read_packets(ColumnDecoder& decoder, std::uint64_t block, reference::RayBlock& out) const;
  std::string describe(const IndexEntry& entry) const;
  [[noreturn]] void refuse(const std::string& section, const std::string& what) const;

  InputFile file_;
  Manifest manifest_;
  std::vector<IndexEntry> index_;
  std::string hash_;
  std::shared_ptr<const cull::CompressionLut> compression_;
  std::vector<std::vector<ColumnPlace>> places_;  ///< of section, column
  std::vector<std::uint64_t> first_ray_{0};
};

}  // namespace ctu::traces
