// The outermost layer of a trace file: frames, their places, and reading bytes at a place. docs/trace-format.md is the
// description; a .ctut file is a legal .zst stream whose header, manifest, index and footer are skippable frames.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ctu::traces {

static_assert(std::endian::native == std::endian::little, "trace files are little-endian and read in place");

inline constexpr std::uint16_t kFormatMajor = 2;  ///< raised when old readers would misread a file
inline constexpr std::uint16_t kFormatMinor = 2;  ///< raised when something is added that old readers may skip
/// Of files whose rays travel in packets, or whose image has spheres or primitive boxes; no others differ.
inline constexpr std::uint16_t kFormatMinorOfExtensions = 3;
inline constexpr std::uint16_t kFormatMinorOfTrees = 4;  ///< of files whose rays walk several trees

inline constexpr std::uint32_t kSkippableMagic = 0x184D2A5C;
inline constexpr std::size_t kSkippableHeaderBytes = 8;
inline constexpr char kHeaderMagic[8] = {'C', 'T', 'U', 'T', 'R', 'A', 'C', 'E'};
inline constexpr char kFooterMagic[8] = {'C', 'T', 'U', 'T', 'E', 'N', 'D', '\n'};
inline constexpr std::uint64_t kMaxManifestBytes = 64u << 20;
inline constexpr std::uint64_t kMaxColumnBytes = 1u << 30;  ///< of one column of one block, uncompressed

/// The first bytes of a file.
struct FileHeader {
  std::uint32_t frame_magic = kSkippableMagic;
  std::uint32_t frame_bytes = 24;
  char magic[8];
  std::uint16_t major = kFormatMajor, minor = kFormatMinor;
  std::uint32_t reserved = 0;
  std::uint64_t checksum = 0;  ///< XXH3-64 of the bytes before it
};
static_assert(sizeof(FileHeader) == 32);

/// The last bytes of a file. Offsets are those of the skippable frames; checksums are of their contents.
struct FileFooter {
  std::uint32_t frame_magic = kSkippableMagic;
  std::uint32_t frame_bytes = 64;
  std::uint64_t manifest_offset = 0, manifest_bytes = 0, manifest_checksum = 0;
  std::uint64_t index_offset = 0, index_entries = 0, index_checksum = 0;
  char magic[8];
  std::uint64_t checksum = 0;  ///< XXH3-64 of the bytes before it
};
static_assert(sizeof(FileFooter) == 72);

/// One column of one block: a zstd frame.
struct IndexEntry {
  std::uint16_t section = 0, column = 0;  ///< positions in the manifest's lists
  std::uint32_t block = 0;
  std::uint64_t offset = 0;
  std::uint32_t stored_bytes = 0;
  std::uint32_t elements = 0;
  std::uint64_t checksum = 0;  ///< XXH3-64 of the elements, little-endian, before shuffling
};
static_assert(sizeof(IndexEntry) == 32);

FileHeader make_header(std::uint16_t minor = kFormatMinor);
void seal(FileFooter& footer);  ///< fills in magic and checksum

/// An open file, read at places; const reads may come from many threads.
class InputFile {
 public:
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size_bytes() const { return size_bytes_; }
  /// Throws Error when the file has fewer bytes.
  void read_at(std::uint64_t offset, void* to, std::size_t bytes, const char* section) const;

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_bytes_ = 0;
};

/// A file written under another name (".part" behind it) and renamed when it is whole; an unfinished one is removed.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::uint64_t position() const { return position_; }
  void write(const void* data, std::size_t bytes);
  void write_skippable(const void* data, std::size_t bytes);
  void commit();  ///< flushes and renames

 private:
  std::string path_, part_path_;
  int descriptor_ = -1;
  std::uint64_t position_ = 0;
  std::vector<std::uint8_t> buffer_;
  void flush();
};

/// Header, footer and index of a file, each checked against its checksum and against the others: the frames lie side by
/// side without a gap from the header to the footer. Throws Error on anything else.
struct FileLayout {
  FileHeader header;
  std::string manifest;  ///< JSON text
  std::vector<IndexEntry> index;
  std::uint64_t index_checksum = 0;
};
FileLayout read_layout(const InputFile& file);

}  // namespace ctu::traces
