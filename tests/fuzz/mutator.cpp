#include "tests/fuzz/mutator.h"

#include <algorithm>
#include <string_view>

namespace ctu::fuzz {
namespace {

/// Numbers that formats stumble over, as text.
constexpr std::string_view kTexts[] = {"0",
                                       "-1",
                                       "1",
                                       "255",
                                       "256",
                                       "65536",
                                       "2147483647",
                                       "2147483648",
                                       "-2147483648",
                                       "4294967295",
                                       "4294967296",
                                       "nan",
                                       "inf",
                                       "1e39",
                                       "-0",
                                       "1e-50",
                                       "1e999",
                                       "99999999999999999999",
                                       "9223372036854775807",
                                       "\n",
                                       " ",
                                       "\""};
/// The same in binary, little-endian.
constexpr std::uint32_t kWords[] = {0,          1,          0x7f,       0x80,       0xff,       0x7fff,
                                    0xffff,     0x10000,    0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000,
                                    0xff800000, 0x7fc00000, 0x7f7fffff, 0x00800000, 0x3f800000};

std::size_t below(std::size_t end, std::mt19937_64& random) { return end == 0 ? 0 : random() % end; }

template <class Bytes>
void insert(InputBytes& to, std::size_t at, const Bytes& what) {
  to.insert(to.begin() + static_cast<std::ptrdiff_t>(at), what.begin(), what.end());
}

void erase(InputBytes& from, std::size_t at, std::size_t count) {
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(at);
  from.erase(first, first + static_cast<std::ptrdiff_t>(std::min(count, from.size() - at)));
}

void write_word(InputBytes& bytes, std::size_t at, std::uint32_t word) {
  for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
    bytes[at + i] = static_cast<std::uint8_t>(word >> (8 * i));
}

/// The digits and signs at a place, replaced by another number.
void change_number(InputBytes& bytes, std::size_t at, std::string_view to) {
  const auto is_part = [&](std::size_t i) {
    return std::string_view("0123456789+-.e").find(static_cast<char>(bytes[i])) != std::string_view::npos;
  };
  std::size_t first = at;
  while (first < bytes.size() && !is_part(first)) ++first;
  std::size_t last = first;
  while (last < bytes.size() && is_part(last)) ++last;
  erase(bytes, first, last - first);
  insert(bytes, first, to);
}

}  // namespace

Mutator::Mutator(std::vector<CorpusFile> corpus, std::vector<InputBytes> dictionary, std::size_t longest_bytes)
    : corpus_(std::move(corpus)), dictionary_(std::move(dictionary)), longest_bytes_(longest_bytes) {}

InputBytes Mutator::next(std::mt19937_64& random) const {
  InputBytes bytes = corpus_[below(corpus_.size(), random)].content;
  for (std::size_t changes = 1 + below(8, random); changes > 0; --changes) change(bytes, random);
  bytes.resize(std::min(bytes.size(), longest_bytes_));
  return bytes;
}

void Mutator::change(InputBytes& bytes, std::mt19937_64& random) const {
  const std::size_t at = below(bytes.size(), random), run = 1 + below(16, random);
  switch (below(dictionary_.empty() ? 9 : 11, random)) {
    case 0:
      if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1u << below(8, random));
      return;
    case 1:
      if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
      return;
    case 2:
      return write_word(bytes, at, kWords[below(std::size(kWords), random)]);
    case 3:
      return change_number(bytes, at, kTexts[below(std::size(kTexts), random)]);
    case 4:
      if (!bytes.empty()) erase(bytes, at, run);
      return;
    case 5:
      return bytes.resize(at);
    case 6: {  // a run once more
      const InputBytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                             bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at + 4 * run, bytes.size())));
      return insert(bytes, at, piece);
    }
    case 7: {  // the rest of another input
      const InputBytes& other = corpus_[below(corpus_.size(), random)].content;
      const std::size_t from = below(other.size(), random);
      bytes.resize(at);
      return insert(bytes, at, InputBytes(other.begin() + static_cast<std::ptrdiff_t>(from), other.end()));
    }
    case 8:
      return insert(bytes, at, kTexts[below(std::size(kTexts), random)]);
    default:
      return insert(bytes, at, dictionary_[below(dictionary_.size(), random)]);
  }
}

}  // namespace ctu::fuzz
