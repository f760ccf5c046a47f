// Columns: what a section of a trace is made of, and how one column of one block becomes a compressed frame. The bytes
// of an element are spread over planes (all first bytes, then all second bytes, ...), because exponents and high bytes
// repeat.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ctu::traces {

/// What one element of a column belongs to: columns of the same unit have equally many elements in a block.
enum class Per : std::uint8_t { Ray, Step, Key, Leaf, Word, Packet, Visit, Entry, Unknown };

struct Column {
  std::string name;
  std::string type;  ///< "f32", "u64", "u32", "u16", "u8"
  Per per = Per::Unknown;
  std::string unit;
  std::string description;
};

struct Section {
  std::string name;
  std::vector<Column> columns;
};

std::string to_string(Per per);
/// Bytes of an element; 0 for a type that we do not know.
std::size_t type_bytes(const std::string& type);

/// The sections of this format version, in file order. Steps have one section for each recorded design.
Section image_section();
/// `with_trees`: rays walk one of several trees.
Section rays_section(bool with_trees);
Section hits_section();
/// What steps have beside those of every trace.
struct StepColumns {
  bool keys = false;    ///< of designs that read tables
  bool met = false;     ///< where the image has primitive_boxes: what ray boxes meet
  bool spared = false;  ///< where rays travel in packets
};
Section steps_section(const std::string& design, const StepColumns& has);
Section packets_section();      ///< only where rays travel in packets
Section compression_section();  ///< only where masks are compressed

/// One column of one block, compressed.
struct EncodedColumn {
  std::uint16_t section = 0, column = 0;
  std::uint32_t elements = 0;
  std::uint64_t checksum = 0;
  std::vector<std::uint8_t> frame;
};

/// Compresses columns. One for each thread.
class ColumnEncoder {
 public:
  ColumnEncoder();
  ~ColumnEncoder();
  ColumnEncoder(ColumnEncoder&&) noexcept;
  /// `data` holds `elements` elements of `width` bytes. Throws Error above kMaxColumnBytes.
  EncodedColumn encode(const void* data, std::size_t elements, std::size_t width);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Fills `to` (elements * width bytes) from a frame. Throws Error, at `where`, unless the frame holds exactly those
/// bytes with that checksum; `to` is never written beyond its end.
class ColumnDecoder {
 public:
  ColumnDecoder();
  ~ColumnDecoder();
  void decode(const std::vector<std::uint8_t>& frame, std::size_t elements, std::size_t width, std::uint64_t checksum,
              void* to, const std::string& path, const std::string& what);
  /// The same test, before anything is allocated: does the frame say that it holds that many bytes?
  static void check_size(const std::vector<std::uint8_t>& frame, std::uint64_t elements, std::size_t width,
                         const std::string& path, const std::string& what);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ctu::traces
