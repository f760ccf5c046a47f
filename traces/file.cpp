#include "traces/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/hash.h"

namespace ctu::traces {
namespace {

constexpr std::size_t kBufferBytes = 1u << 20;
constexpr const char* kRecordAgain = "record the trace again, or copy it again from where it came";

[[noreturn]] void refuse(const std::string& path, const char* section, const std::string& what,
                         const char* remedy = kRecordAgain) {
  throw Error(path, fmt::format("{}: {}", section, what), remedy);
}

template <class Frame>
std::uint64_t checksum_of(const Frame& frame) {
  return hash64(&frame, offsetof(Frame, checksum));
}

FileHeader read_header(const InputFile& file) {
  FileHeader header;
  const auto foreign = [&] {
    refuse(file.path(), "header", "this is not a trace file", "give a .ctut file made by `ctusim record`");
  };
  if (file.size_bytes() < sizeof header) foreign();
  file.read_at(0, &header, sizeof header, "header");
  if (header.frame_magic != kSkippableMagic || std::memcmp(header.magic, kHeaderMagic, sizeof kHeaderMagic) != 0)
    foreign();
  if (header.checksum != checksum_of(header) || header.frame_bytes != FileHeader{}.frame_bytes)
    refuse(file.path(), "header", "damaged: its checksum does not match");
  if (header.major != kFormatMajor)
    refuse(file.path(), "header",
           fmt::format("format version {}.{}; this program reads version {}", header.major, header.minor, kFormatMajor),
           header.major > kFormatMajor ? "use a newer program" : "record the trace again with this program");
  return header;
}

FileFooter read_footer(const InputFile& file) {
  FileFooter footer;
  if (file.size_bytes() < sizeof(FileHeader) + sizeof footer) refuse(file.path(), "footer", "the file is cut short");
  file.read_at(file.size_bytes() - sizeof footer, &footer, sizeof footer, "footer");
  if (footer.frame_magic != kSkippableMagic || std::memcmp(footer.magic, kFooterMagic, sizeof kFooterMagic) != 0)
    refuse(file.path(), "footer", "missing: the file is cut short, or bytes follow its end");
  if (footer.checksum != checksum_of(footer) || footer.frame_bytes != FileFooter{}.frame_bytes)
    refuse(file.path(), "footer", "damaged: its checksum does not match");
  return footer;
}

/// Checks the eight bytes in front of a skippable frame's content.
void check_frame(const InputFile& file, std::uint64_t offset, std::uint64_t content_bytes, const char* section) {
  std::uint32_t head[2];
  file.read_at(offset, head, sizeof head, section);
  if (head[0] != kSkippableMagic || head[1] != content_bytes) refuse(file.path(), section, "damaged frame header");
}

void check_index(const InputFile& file, const FileLayout& layout, const FileFooter& footer) {
  std::uint64_t place = sizeof(FileHeader);
  for (const IndexEntry& entry : layout.index) {
    if (entry.offset != place || entry.stored_bytes > footer.manifest_offset - place)
      refuse(file.path(), "index", "frames do not lie side by side");
    place += entry.stored_bytes;
  }
  if (place != footer.manifest_offset) refuse(file.path(), "index", "frames do not end where the manifest begins");
}

}  // namespace

FileHeader make_header(std::uint16_t minor) {
  FileHeader header;
  header.minor = minor;
  std::memcpy(header.magic, kHeaderMagic, sizeof header.magic);
  header.checksum = checksum_of(header);
  return header;
}

void seal(FileFooter& footer) {
  std::memcpy(footer.magic, kFooterMagic, sizeof footer.magic);
  footer.checksum = checksum_of(footer);
}

FileLayout read_layout(const InputFile& file) {
  FileLayout layout;
  layout.header = read_header(file);
  const FileFooter footer = read_footer(file);
  // Sizes are compared by subtraction from what is known to fit, so nothing can wrap.
  const std::uint64_t end = file.size_bytes() - sizeof footer;
  const std::uint64_t frames = 2 * kSkippableHeaderBytes;
  if (footer.manifest_bytes > kMaxManifestBytes || footer.index_entries > (UINT32_MAX / sizeof(IndexEntry)) ||
      footer.manifest_offset < sizeof(FileHeader) || footer.manifest_offset > end ||
      end - footer.manifest_offset != frames + footer.manifest_bytes + footer.index_entries * sizeof(IndexEntry) ||
      footer.index_offset != footer.manifest_offset + kSkippableHeaderBytes + footer.manifest_bytes)
    refuse(file.path(), "footer", "places and sizes do not fit the file");

  check_frame(file, footer.manifest_offset, footer.manifest_bytes, "manifest");
  layout.manifest.resize(footer.manifest_bytes);
  file.read_at(footer.manifest_offset + kSkippableHeaderBytes, layout.manifest.data(), layout.manifest.size(),
               "manifest");
  if (hash64(layout.manifest.data(), layout.manifest.size()) != footer.manifest_checksum)
    refuse(file.path(), "manifest", "damaged: its checksum does not match");

  const std::uint64_t index_bytes = footer.index_entries * sizeof(IndexEntry);
  check_frame(file, footer.index_offset, index_bytes, "index");
  layout.index.resize(footer.index_entries);
  file.read_at(footer.index_offset + kSkippableHeaderBytes, layout.index.data(), index_bytes, "index");
  layout.index_checksum = footer.index_checksum;
  if (hash64(layout.index.data(), index_bytes) != footer.index_checksum)
    refuse(file.path(), "index", "damaged: its checksum does not match");
  check_index(file, layout, footer);
  return layout;
}

// Without waiting, as the opening of a pipe would.
InputFile::InputFile(const std::string& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0)
    throw Error(path, fmt::format("cannot be opened: {}", std::strerror(errno)), "check the path and its permissions");
  struct stat status;
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw Error(path, "is not a regular file", "give a .ctut file made by `ctusim record`");
  }
  size_bytes_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read_at(std::uint64_t offset, void* to, std::size_t bytes, const char* section) const {
  auto* place = static_cast<std::uint8_t*>(to);
  while (bytes > 0) {
    const ssize_t got = ::pread(descriptor_, place, bytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(path_, section, fmt::format("cannot be read: {}", std::strerror(errno)));
    if (got == 0) refuse(path_, section, "the file is cut short");
    place += got, offset += static_cast<std::uint64_t>(got), bytes -= static_cast<std::size_t>(got);
  }
}

// A device or a pipe would be replaced by the file that is renamed to it.
OutputFile::OutputFile(const std::string& path) : path_(path), part_path_(path + ".part") {
  struct stat status;
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Error(path, "is a folder, a pipe or a device", "name a file");
  descriptor_ = ::open(part_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw Error(path, fmt::format("cannot be written: {}", std::strerror(errno)),
                "check the folder and its permissions");
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(part_path_.c_str());
}

void OutputFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t wrote = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0)
      throw Error(path_, fmt::format("cannot be written: {}", std::strerror(errno)), "check the space on the disk");
    done += static_cast<std::size_t>(wrote);
  }
  buffer_.clear();
}

void OutputFile::write(const void* data, std::size_t bytes) {
  const auto* first = static_cast<const std::uint8_t*>(data);
  buffer_.insert(buffer_.end(), first, first + bytes);
  position_ += bytes;
  if (buffer_.size() >= kBufferBytes) flush();
}

void OutputFile::write_skippable(const void* data, std::size_t bytes) {
  if (bytes > UINT32_MAX) throw Error(path_, "a frame of more than 4 GiB", "record fewer rays");
  const std::uint32_t head[2] = {kSkippableMagic, static_cast<std::uint32_t>(bytes)};
  write(head, sizeof head);
  write(data, bytes);
}

void OutputFile::commit() {
  flush();
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 || std::rename(part_path_.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    ::unlink(part_path_.c_str());
    throw Error(path_, fmt::format("cannot be written: {}", std::strerror(reason)),
                "check the folder and the space on the disk");
  }
}

}  // namespace ctu::traces
