#include "sim/ladder/profile_store.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "model/base/hash.h"

namespace ctu::ladder {
namespace {

// Another layout of Phase is another format.
constexpr char kMagic[] = "ctusim profile 1\n";

std::filesystem::path users_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0')
    return std::filesystem::path(cache) / "ctusim" / "profiles";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return std::filesystem::path(home) / ".cache" / "ctusim" / "profiles";
  return std::filesystem::temp_directory_path() / "ctusim-profiles";
}

/// A file only its writer reads again, on the same machine: numbers as they lie in memory.
class Writer {
 public:
  void add(const void* data, std::size_t bytes) { bytes_.append(static_cast<const char*>(data), bytes); }
  void add(std::uint64_t number) { add(&number, sizeof number); }
  void add(const std::string& text) {
    add(text.size());
    add(text.data(), text.size());
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Asked for more than is there, gives zeros and is not whole.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  bool read(void* data, std::size_t count) {
    if (count > bytes_.size() - at_) return whole_ = false;
    std::memcpy(data, bytes_.data() + at_, count);
    at_ += count;
    return true;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    read(&value, sizeof value);
    return value;
  }
  std::string text() {
    std::string value(std::min<std::uint64_t>(number(), bytes_.size()), '\0');
    read(value.data(), value.size());
    return value;
  }
  std::size_t rest() const { return bytes_.size() - at_; }
  bool whole() const { return whole_; }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool whole_ = true;
};

std::string to_bytes(const std::string& key, const VisitProfile& profile) {
  Writer out;
  out.add(key);
  out.add(profile.rays_in_all);
  out.add(profile.tables.size());
  for (const TableUse& use : profile.tables) {
    out.add(use.name);
    for (const std::uint64_t number : {use.rows, use.row_bits, use.reads, use.shared_reads, use.rows_used})
      out.add(number);
  }
  out.add(sizeof(Phase));
  out.add(profile.phases.size());
  out.add(profile.phases.data(), profile.phases.size() * sizeof(Phase));
  return out.bytes();
}

std::optional<VisitProfile> from_bytes(const std::string& key, const std::string& bytes) {
  Reader in(bytes);
  if (in.text() != key) return std::nullopt;
  VisitProfile profile;
  profile.rays_in_all = in.number();
  profile.tables.resize(std::min<std::uint64_t>(in.number(), 16));
  for (TableUse& use : profile.tables) {
    use.name = in.text();
    for (std::uint64_t* number : {&use.rows, &use.row_bits, &use.reads, &use.shared_reads, &use.rows_used})
      *number = in.number();
  }
  if (in.number() != sizeof(Phase)) return std::nullopt;
  const std::uint64_t phases = in.number();
  if (!in.whole() || phases > in.rest() / sizeof(Phase)) return std::nullopt;
  profile.phases.resize(phases);
  in.read(profile.phases.data(), phases * sizeof(Phase));
  return profile;
}

}  // namespace

ProfileStore::ProfileStore(std::filesystem::path folder)
    : folder_(folder.empty() ? users_folder() : std::move(folder)) {}

std::filesystem::path ProfileStore::file(const std::string& key) const {
  return folder_ / (hash_bytes(key.data(), key.size()).hex() + ".profile");
}

std::optional<VisitProfile> ProfileStore::find(const std::string& key) const {
  std::ifstream in(file(key), std::ios::binary);
  if (!in) return std::nullopt;
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  constexpr std::size_t kHead = sizeof kMagic - 1 + sizeof(std::uint64_t);
  if (whole.size() < kHead || whole.compare(0, sizeof kMagic - 1, kMagic) != 0) return std::nullopt;
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, whole.data() + sizeof kMagic - 1, sizeof checksum);
  const std::string bytes = whole.substr(kHead);
  if (hash64(bytes.data(), bytes.size()) != checksum) return std::nullopt;
  return from_bytes(key, bytes);
}

void ProfileStore::keep(const std::string& key, const VisitProfile& profile) const {
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (failure) return;
  const std::string bytes = to_bytes(key, profile);
  const std::uint64_t checksum = hash64(bytes.data(), bytes.size());
  // Under another name first: runs side by side may keep the same one.
  const std::filesystem::path whole = file(key), partial = whole.string() + fmt::format(".{}", ::getpid());
  {
    std::ofstream out(partial, std::ios::binary);
    out << kMagic;
    out.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
    out << bytes;
    if (!out.flush()) {
      std::filesystem::remove(partial, failure);
      return;
    }
  }
  std::filesystem::rename(partial, whole, failure);
  if (failure) std::filesystem::remove(partial, failure);
}

}  // namespace ctu::ladder
