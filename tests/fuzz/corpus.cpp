#include "tests/fuzz/corpus.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace ctu::fuzz {
namespace {

namespace fs = std::filesystem;

/// The word between the quotes of a line NAME="word" or "word", with \xHH, \\ and \" undone.
InputBytes word_of(const std::string& line) {
  InputBytes word;
  const std::size_t first = line.find('"'), last = line.rfind('"');
  for (std::size_t i = first + 1; i < last; ++i) {
    if (line[i] != '\\') {
      word.push_back(static_cast<std::uint8_t>(line[i]));
    } else if (line[i + 1] == 'x') {
      std::uint8_t value = 0;
      std::from_chars(line.data() + i + 2, line.data() + i + 4, value, 16);
      word.push_back(value);
      i += 3;
    } else {
      word.push_back(static_cast<std::uint8_t>(line[++i]));
    }
  }
  return word;
}

}  // namespace

CorpusFile read_input(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path, "cannot be read", "check the name");
  return {path, {std::istreambuf_iterator<char>(in), {}}};
}

std::vector<CorpusFile> read_corpus(const std::string& folder, std::string_view name) {
  const fs::path from = fs::path(folder) / "corpus" / name;
  std::vector<CorpusFile> files;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(from, absent)) files.push_back(read_input(entry.path().string()));
  if (files.empty()) throw Error(from.string(), "there are no inputs", "every harness has seeds: add some");
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

std::vector<InputBytes> read_dictionary(const std::string& folder, std::string_view name) {
  std::ifstream in(fs::path(folder) / "dictionaries" / (std::string(name) + ".dict"));
  std::vector<InputBytes> words;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#' && line.find('"') < line.rfind('"')) words.push_back(word_of(line));
  return words;
}

}  // namespace ctu::fuzz
